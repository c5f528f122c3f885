#pragma once

#include "tools/figures/tracked_robot.hpp"

/// Small worlds, described in code: what the tests of physics, sensing and simulation stand on.
namespace cohort::testing {

using description::at;
using description::place;
using description::solid_cylinder;
using description::static_shape;

/// A robot with tracks, a turret on a motor, encoders and a ring of 15 proximity sensors.
inline description::Model tracked_robot(double noise = 0.0) {
  using namespace description;
  Model model = figures::tracked_robot();
  model.name = "tracked_robot";
  model.devices.push_back(VelocityMotor{"turret", 0, 1.5, 0.3});
  model.devices.push_back(JointEncoder{"turret", 0});
  model.devices.push_back(TreelEncoder{"treel", 0});
  ProximityRing ring{"proximity", 1, {{0, 0, 0.02}}, 15, 0.20943951023931953, 0.41887902047863906, 0.058, 0.2};
  if (noise > 0.0) {
    ring.readout.noises.emplace_back();
    ring.readout.noises[0].deviation = noise;
  }
  model.devices.push_back(ring);
  return model;
}

inline description::World world_with_floor(double friction = 1.0) {
  description::World world;
  world.name = "test";
  place(world, static_shape("floor", description::Plane{}, {friction, 0.0}), "floor", {});
  return world;
}

}  // namespace cohort::testing
