// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cohort::description {

/// When a bridge to ROS 2 answers a frame.
enum class RosSync {
  free,     ///< immediately, with the newest command
  command,  ///< after a command for it has arrived
  idle,     ///< once the nodes wait for the next clock time
};

/// Response of a bridge if no node answers within `Ros2Settings::wait`.
enum class RosOnSilence {
  wait,   ///< keeps waiting
  hold,   ///< repeats the last command
  stand,  ///< the robot stands still
};

enum class RosOdometry {
  encoders,  ///< the wheel encoders
  truth,     ///< the true pose of the robot
};

/// Settings of a topic of a robot.
struct Ros2Topic {
  std::string topic;  ///< name in Cohort, such as `scan`; `*` matches any characters
  bool is_published = true;
  std::string name;            ///< name in ROS: absolute, or relative to the namespace of the robot; empty for `topic`
  std::optional<double> rate;  ///< [Hz]; if absent, at every new value
  int line = 0;                ///< in the file of the experiment
};

/// Conversion of velocity commands to the wheel velocities of a model of any kind.
struct Ros2Drive {
  std::vector<std::string> left, right;  ///< command channels, of angular velocities of wheels
  double wheel_radius = 0.0;             ///< [m]
  double wheel_separation = 0.0;         ///< [m] distance between the left and the right wheels
  int line = 0;                          ///< in the file of the experiment
};

/// ROS 2 interface of robots.
struct Ros2Settings {
  RosSync sync = RosSync::free;
  std::optional<std::chrono::nanoseconds> wait{};  ///< maximum wall time for one frame; unlimited if absent
  RosOnSilence on_silence = RosOnSilence::wait;
  std::string reply_to{};    ///< topic (name in Cohort) that commands answer; empty for the least frequent
  std::string name_space{};  ///< such as `/` or `/left`; empty for `/` and the scoped name of the robot
  std::string frames{};      ///< prefix of the names of frames
  RosOdometry odometry = RosOdometry::encoders;
  std::string base_frame = "base_link";  ///< frame of the root link
  std::vector<Ros2Topic> topics{};       ///< later ones override earlier ones
  std::optional<Ros2Drive> drive{};      ///< if absent, defined by the devices of the model
};

/// Settings of an experiment for a bridge to ROS 2. The server does not use them.
struct Ros2 {
  std::optional<std::uint32_t> domain{};      ///< ROS_DOMAIN_ID if absent
  std::vector<std::string> robots = {"all"};  ///< selectors of the robots that are visible in ROS
  Ros2Settings common{};
  std::map<std::string, Ros2Settings> teams{};  ///< by name: complete settings of each team that has its own

  const Ros2Settings& of_team(const std::string& team) const {
    const auto own = teams.find(team);
    return own == teams.end() ? common : own->second;
  }
};

}  // namespace cohort::description
