#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"
#include "idl/messages/ros_messages.hpp"
#include "server/description/model.hpp"

/// The frames of a robot, as tf2 has them: those of its links, and those of its sensors on them.
namespace cohort::ros2 {

/// A frame of a sensor on a link.
struct SensorFrame {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
};

class FrameTree {
 public:
  /// `base`: the name of the root link's frame. `prefix`: of the names of all frames. `sensors`: those to be told too.
  FrameTree(const description::Model& model, const Start& robot, const std::string& base, const std::string& prefix,
            const std::vector<SensorFrame>& sensors);

  /// Returns what never changes: links that fixed joints hold, and sensors.
  messages::ros::TFMessage fixed(const messages::ros::Time& stamp) const;
  /// Adds what moves, as the robot's encoders measure it. Joints without an encoder are left out.
  void add_moving(std::span<const double> observation, const messages::ros::Time& stamp,
                  messages::ros::TFMessage& to) const;

  const std::string& base() const { return base_; }
  const std::string& prefix() const { return prefix_; }
  /// Returns the name of a frame for the sensor or link of this name, as headers have it.
  std::string name_of(const std::string& frame) const { return prefix_ + frame; }

 private:
  struct Edge {
    std::string parent;
    std::string child;
    Pose X_PC;  ///< where the joint is at 0
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
