// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world_in_code.hpp"

namespace cohort::figures {

inline constexpr std::size_t chassis = 0;
inline constexpr std::size_t turret = 1;
inline constexpr double turret_height = 0.055;  ///< z of the turret's link [m]
inline constexpr double turret_radius = 0.058;  ///< [m]

/// Returns a robot like the s-bot: 0.7 kg, a round chassis with tracks and a round turret on a joint. They are links 0
/// and 1, joint 0 and device 0.
inline description::Model tracked_robot() {
  using namespace description;
  Model model;
  model.name = "robot";
  model.links.push_back({"chassis",
                         {},
                         solid_cylinder(0.4, 0.05, 0.05, 0.033),
                         {{"hull", {{0, 0, 0.034}}, Cylinder{0.05, 0.04}, {0.3, 0}}}});
  model.links.push_back({"turret",
                         {{0, 0, turret_height}},
                         solid_cylinder(0.3, turret_radius, 0.04, 0.02),
                         {{"shell", {{0, 0, 0.02}}, Cylinder{turret_radius, 0.04}, {0.3, 0}}}});
  Joint joint;
  joint.name = "turret_joint";
  joint.type = JointType::revolute;
  joint.parent = chassis;
  joint.child = turret;
  model.joints.push_back(joint);
  TreelDrive drive{{chassis, 0.04, 0.04, 0.0, 0.022, 0.02, 0.2, 0.8}, "treel"};
  model.devices.emplace_back(drive);
  return model;
}

}  // namespace cohort::figures
