// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"
#include "idl/messages/ros_messages.hpp"
#include "server/description/model.hpp"

/// The tf2 frames of a robot: those of its links and of the sensors on them.
namespace cohort::ros2 {

/// A frame of a sensor on a link.
struct SensorFrame {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
};

class FrameTree {
 public:
  /// `base` is the name of the root link's frame, `prefix` the prefix of all frame names. `sensors` are included in the
  /// tree.
  FrameTree(const description::Model& model, const Start& robot, const std::string& base, const std::string& prefix,
            const std::vector<SensorFrame>& sensors);

  /// Returns the static transforms: those of links on fixed joints and of sensors.
  messages::ros::TFMessage fixed(const messages::ros::Time& stamp) const;
  /// Adds the transforms of moving joints, as the robot's encoders measure them. Joints without an encoder are left
  /// out.
  void add_moving(std::span<const double> observation, const messages::ros::Time& stamp,
                  messages::ros::TFMessage& to) const;

  const std::string& base() const { return base_; }
  const std::string& prefix() const { return prefix_; }
  /// Returns the frame id of the sensor or link of this name.
  std::string name_of(const std::string& frame) const { return prefix_ + frame; }

 private:
  struct Edge {
    std::string parent;
    std::string child;
    Pose X_PC;  ///< at joint position 0
  };
  struct MovingEdge : Edge {
    Pose X_PJ;
    Pose X_JC;
    Eigen::Vector3d axis;  ///< in J
    bool slides = false;
    std::size_t offset = 0;  ///< index of the position among the observed values
  };

  std::string base_;
  std::string prefix_;
  std::vector<Edge> fixed_;
  std::vector<MovingEdge> moving_;
};

messages::ros::Transform to_transform(const Pose& pose);

}  // namespace cohort::ros2
