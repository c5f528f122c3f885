// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/frame_tree.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;
using std::numbers::pi;

Pose to_pose(const ros::Transform& transform) {
  const auto& [p, q] = transform;
  Pose pose;
  pose.position = {p.x, p.y, p.z};
  pose.orientation = {q.w, q.x, q.y, q.z};
  return pose;
}

// A base, a turret that turns about an axis at x = 1 in it, and a mast that is fixed on the turret.
struct Turret {
  Turret() {
    model.links.resize(3);
    model.links[0].name = "hull";
    model.links[1].name = "turret";
    model.links[1].X_ML.position = {1.0, 0.0, 0.5};
    model.links[2].name = "mast";
    model.links[2].X_ML.position = {1.5, 0.0, 1.0};
    model.joints.resize(2);
    model.joints[0].name = "turn";
    model.joints[0].type = description::JointType::revolute;
    model.joints[0].child = 1;
    model.joints[1].parent = 1;
    model.joints[1].child = 2;
    model.devices = {description::JointEncoder{"turn", 0}};
    ChannelInfo position;
    position.name = "turn/0/position";
    position.offset = 1;
    robot.observation_channels = {position};
  }
  FrameTree tree(const std::string& prefix = "") const {
    SensorFrame camera{"camera", 2, {}};
    camera.X_LS.position = {0.0, 0.0, 0.25};
    return {model, robot, "base_link", prefix, {camera}};
  }

  description::Model model;
  Start robot;
};

TEST(Ros2FrameTree, PublishesLinksAndSensorsOnceAndJointsWithAnEncoderRepeatedly) {
  const FrameTree tree = Turret().tree("left/");
  const ros::TFMessage fixed = tree.fixed({1, 2});
  ASSERT_EQ(fixed.transforms.size(), 2U);
  EXPECT_EQ(fixed.transforms[0].header.frame_id, "left/turret");
  EXPECT_EQ(fixed.transforms[0].child_frame_id, "left/mast");
  EXPECT_EQ(fixed.transforms[0].header.stamp, (ros::Time{1, 2}));
  EXPECT_EQ(fixed.transforms[1].header.frame_id, "left/mast");
  EXPECT_EQ(fixed.transforms[1].child_frame_id, "left/camera");
  ros::TFMessage moving;
  tree.add_moving(std::vector<double>{9.0, 0.0}, {1, 2}, moving);
  ASSERT_EQ(moving.transforms.size(), 1U);
  EXPECT_EQ(moving.transforms[0].header.frame_id, "left/base_link");
  EXPECT_EQ(moving.transforms[0].child_frame_id, "left/turret");
  EXPECT_EQ(tree.base(), "left/base_link");
  EXPECT_EQ(tree.name_of("scan"), "left/scan");
}

TEST(Ros2FrameTree, ASensorIsWhereItsJointsCarryIt) {
  const FrameTree tree = Turret().tree();
  ros::TFMessage moving;
  tree.add_moving(std::vector<double>{9.0, pi / 2}, {}, moving);
  const ros::TFMessage fixed = tree.fixed({});
  const Pose X_BC = to_pose(moving.transforms[0].transform) * to_pose(fixed.transforms[0].transform) *
                    to_pose(fixed.transforms[1].transform);
  EXPECT_TRUE(X_BC.position.isApprox(Eigen::Vector3d(1.0, 0.5, 1.25), 1e-12)) << X_BC.position.transpose();
}

TEST(Ros2FrameTree, AJointTurnsAboutItsPlaceInTheChild) {
  Turret turret;
  turret.model.joints[0].X_LJ.position = {0.5, 0.0, 0.0};  // the axis is at x = 1.5
  ros::TFMessage moving;
  turret.tree().add_moving(std::vector<double>{0.0, pi}, {}, moving);
  const Pose X_BT = to_pose(moving.transforms[0].transform);
  EXPECT_TRUE(X_BT.position.isApprox(Eigen::Vector3d(2.0, 0.0, 0.5), 1e-12)) << X_BT.position.transpose();
}

TEST(Ros2FrameTree, AJointThatSlidesCarriesItsLinkAlongItsAxis) {
  Turret turret;
  turret.model.joints[0].type = description::JointType::prismatic;
  ros::TFMessage moving;
  turret.tree().add_moving(std::vector<double>{0.0, 0.25}, {}, moving);
  const Pose X_BT = to_pose(moving.transforms[0].transform);
  EXPECT_TRUE(X_BT.position.isApprox(Eigen::Vector3d(1.0, 0.0, 0.75), 1e-12)) << X_BT.position.transpose();
}

TEST(Ros2FrameTree, JointsWithoutAnEncoderAndToTheWorldAreLeftOut) {
  Turret turret;
  turret.robot.observation_channels.clear();
  ros::TFMessage moving;
  turret.tree().add_moving(std::vector<double>{0.0, 0.25}, {}, moving);
  EXPECT_TRUE(moving.transforms.empty());
  turret.model.joints[1].parent = description::Joint::world;
  EXPECT_EQ(turret.tree().fixed({}).transforms.size(), 1U);
}

}  // namespace
}  // namespace cohort::ros2
