// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world.hpp"
#include "server/parsing/keys/device_keys.hpp"
#include "server/parsing/plugins/plugin.hpp"

/// Conversion of the supported plugins of Gazebo, by the names of their classes; docs/gazebo.md has the table.
namespace cohort::parsing {

template <class Kind>
ModelPlugin::Values ModelPlugin::as() {
  return {*this, keys::extension_of<Kind>};
}

void diff_drive(ModelPlugin& plugin);
void ackermann_steering(ModelPlugin& plugin);
void tracked_vehicle(ModelPlugin& plugin);
void track_controller(ModelPlugin& plugin);
void joint_controller(ModelPlugin& plugin);
void joint_position_controller(ModelPlugin& plugin);
void joint_state_publisher(ModelPlugin& plugin);
void multicopter_motor_model(ModelPlugin& plugin);
void thruster(ModelPlugin& plugin);
void lift_drag(ModelPlugin& plugin);
void hydrodynamics(ModelPlugin& plugin);
void detachable_joint(ModelPlugin& plugin);
void linear_battery(ModelPlugin& plugin);

void buoyancy(Plugin& plugin, World& world);
void wind_effects(Plugin& plugin, World& world);

}  // namespace cohort::parsing
