#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "server/recording/cdr.hpp"
#include "server/recording/mcap/writing/recording_file.hpp"
#include "server/recording/ros_messages.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// Something that robots of a kind sense, and for which ROS has a message.
struct StandardSensor {
  std::string name;       ///< of the device, and what it measures if that takes several messages: `air/temperature`
  std::string device;     ///< whose place S is
  const char* type = "";  ///< of the message, such as `sensor_msgs/msg/LaserScan`
  std::function<SchemaId(RecordingFile&)> add_schema;
  /// Adds the message of what a robot of the kind observes.
  std::function<void(CdrWriter&, const ros::Header&, std::span<const double> observation)> add;
  /// X_WS of a body of the kind; empty if it is nowhere.
  std::function<Pose(const physics::World&, std::uint32_t body)> place;
};

/// Those of a model, in the order of its devices: lidars, IMUs, accelerometers, magnetometers, force and torque, air
/// pressure, climate, batteries.
std::vector<StandardSensor> standard_sensors(const description::Model& model, const RobotKind& kind);

}  // namespace cohort::recording
