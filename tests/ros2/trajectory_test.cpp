// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;
using namespace std::chrono_literals;

ros::JointTrajectory trajectory(const std::vector<std::string>& joints,
                                const std::vector<std::pair<std::chrono::milliseconds, std::vector<double>>>& points) {
  ros::JointTrajectory message;
  message.joint_names = joints;
  for (const auto& [time, positions] : points) {
    ros::JointTrajectoryPoint point;
    point.positions = positions;
    point.time_from_start.sec = static_cast<std::int32_t>(time / 1s);
    point.time_from_start.nanosec = static_cast<std::uint32_t>((time % 1s) / 1ns);
    message.points.push_back(point);
  }
  return message;
}

Trajectory arm() { return Trajectory({{"lift", 0}, {"bend", 2}}); }

std::vector<double> at(Trajectory& moving, std::chrono::nanoseconds time, std::vector<double> command) {
  moving.advance(time, command);
  return command;
}

using Values = std::vector<double>;

TEST(Ros2Trajectory, JointsMoveUniformlyFromTheirPositionToEachPoint) {
  Trajectory moving = arm();
  const Values now = {1.0, 7.0, -1.0};
  moving.begin(trajectory({"bend", "lift"}, {{1000ms, {1.0, 3.0}}, {1500ms, {1.0, 4.0}}}), now);
  EXPECT_EQ(at(moving, 10s, now), now);  // begins when it is first asked
  EXPECT_EQ(at(moving, 10500ms, now), (Values{2.0, 7.0, 0.0}));
  EXPECT_EQ(at(moving, 11s, now), (Values{3.0, 7.0, 1.0}));
  EXPECT_EQ(at(moving, 11250ms, now), (Values{3.5, 7.0, 1.0}));
  EXPECT_EQ(at(moving, 11500ms, now), (Values{4.0, 7.0, 1.0}));
  EXPECT_EQ(at(moving, 12s, {5.0, 7.0, 5.0}), (Values{5.0, 7.0, 5.0})) << "it is over, and others may command";
}

TEST(Ros2Trajectory, TheEndIsReachedBetweenTwoTicks) {
  Trajectory moving = arm();
  moving.begin(trajectory({"lift"}, {{100ms, {2.0}}}), Values{0.0, 0.0, 0.0});
  at(moving, 0s, {0.0, 0.0, 0.0});
  EXPECT_EQ(at(moving, 70s, {0.0, 0.0, 0.0}), (Values{2.0, 0.0, 0.0}));
}

TEST(Ros2Trajectory, AStampSaysWhenItBegins) {
  Trajectory moving = arm();
  ros::JointTrajectory message = trajectory({"lift"}, {{1000ms, {1.0}}});
  message.header.stamp = {5, 0};
  moving.begin(message, Values{0.0, 0.0, 0.0});
  EXPECT_EQ(at(moving, 4s, {9.0, 0.0, 0.0}), (Values{9.0, 0.0, 0.0}));
  EXPECT_EQ(at(moving, 5250ms, {9.0, 0.0, 0.0}), (Values{0.25, 0.0, 0.0}));
  message.header.stamp = {0, 500'000'000};  // has begun before
  moving.begin(message, Values{0.0, 0.0, 0.0});
  EXPECT_EQ(at(moving, 1s, {9.0, 0.0, 0.0}), (Values{0.5, 0.0, 0.0}));
}

TEST(Ros2Trajectory, APointWithoutDelayIsAJump) {
  Trajectory moving = arm();
  moving.begin(trajectory({"lift"}, {{0ms, {2.0}}, {1000ms, {3.0}}}), Values{0.0, 0.0, 0.0});
  EXPECT_EQ(at(moving, 1s, {0.0, 0.0, 0.0}), (Values{2.0, 0.0, 0.0}));
  EXPECT_EQ(at(moving, 1500ms, {0.0, 0.0, 0.0}), (Values{2.5, 0.0, 0.0}));
}

TEST(Ros2Trajectory, ATrajectoryWithoutPointsEndsTheCurrentOne) {
  Trajectory moving = arm();
  moving.begin(trajectory({"lift"}, {{1000ms, {1.0}}}), Values{0.0, 0.0, 0.0});
  at(moving, 1s, {0.0, 0.0, 0.0});
  moving.begin(trajectory({}, {}), Values{0.0, 0.0, 0.0});
  EXPECT_EQ(at(moving, 1500ms, {0.3, 0.0, 0.0}), (Values{0.3, 0.0, 0.0}));
}

TEST(Ros2Trajectory, EndsWhereItIs) {
  Trajectory moving = arm();
  moving.begin(trajectory({"lift"}, {{1000ms, {1.0}}}), Values{0.0, 0.0, 0.0});
  at(moving, 1s, {0.0, 0.0, 0.0});
  moving.end();
  EXPECT_EQ(at(moving, 1500ms, {0.3, 0.0, 0.0}), (Values{0.3, 0.0, 0.0}));
}

TEST(Ros2Trajectory, AnErrorIsReportedAndKeepsTheCurrentTrajectory) {
  Trajectory moving = arm();
  moving.begin(trajectory({"lift"}, {{1000ms, {1.0}}}), Values{0.0, 0.0, 0.0});
  at(moving, 1s, {0.0, 0.0, 0.0});
  const auto expect_error = [&](const ros::JointTrajectory& message, const std::string& text) {
    try {
      moving.begin(message, Values{0.0, 0.0, 0.0});
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), text);
    }
  };
  expect_error(trajectory({"tail"}, {}), "it has no position-controlled joint 'tail'; there are lift, bend");
  expect_error(trajectory({"lift"}, {{100ms, {1.0, 2.0}}}), "a point has 2 positions for 1 joints");
  expect_error(trajectory({"lift"}, {{100ms, {NAN}}}), "a position is not finite");
  expect_error(trajectory({"lift"}, {{100ms, {1.0}}, {50ms, {1.0}}}),
               "the times of its points must be non-negative and in ascending order");
  expect_error(trajectory({"lift"}, {{-1000ms, {1.0}}}),
               "the times of its points must be non-negative and in ascending order");
  EXPECT_EQ(at(moving, 1500ms, {0.0, 0.0, 0.0}), (Values{0.5, 0.0, 0.0}));
}

}  // namespace
}  // namespace cohort::ros2
