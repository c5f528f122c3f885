// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "server/description/ground_drive.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

/// Tests of how a person drives a model over the ground.
namespace cohort::description {
namespace {

constexpr double rounding = 1e-12;

struct Wheel {
  std::string name;
  double x, y;
  std::string axis = "0 1 0";
  double radius = 0.1;
  double z = 0.1;
  std::string limits{};
};

std::string wheel_text(const Wheel& wheel) {
  // The axis of the cylinder is that of the joint.
  const std::string turned = wheel.axis == "1 0 0" ? "0 1.5707963267948966 0" : "1.5707963267948966 0 0";
  return "<link name='" + wheel.name + "'><pose>" + std::to_string(wheel.x) + " " + std::to_string(wheel.y) + " " +
         std::to_string(wheel.z) +
         " 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
         "<collision name='tyre'><pose>0 0 0 " +
         turned + "</pose><geometry><cylinder><radius>" + std::to_string(wheel.radius) +
         "</radius><length>0.05</length></cylinder></geometry></collision></link><joint name='" + wheel.name +
         "_axle' type='revolute'><parent>a</parent><child>" + wheel.name + "</child><axis><xyz>" + wheel.axis +
         "</xyz>" + wheel.limits + "</axis></joint><cohort:velocity_motor name='" + wheel.name + "'><cohort:joint>" +
         wheel.name +
         "_axle</cohort:joint><cohort:max_velocity>8</cohort:max_velocity><cohort:max_effort>1</cohort:max_effort>"
         "</cohort:velocity_motor>";
}

std::string belt_text(const std::string& name, double y, const std::string& axis) {
  return "<link name='" + name + "'><pose>0 " + std::to_string(y) +
         " 0.1 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
         "<collision name='track'><geometry><box><size>0.6 0.1 0.2</size></box></geometry></collision></link>"
         "<joint name='" +
         name + "_mount' type='fixed'><parent>a</parent><child>" + name + "</child></joint><cohort:belt name='" + name +
         "'><cohort:link>" + name + "</cohort:link><cohort:axis>" + axis +
         "</cohort:axis><cohort:max_velocity>0.5</cohort:max_velocity></cohort:belt>";
}

class GroundDrives : public Description {
 protected:
  std::vector<DriveChannel> drive_of(const std::string& content) const {
    const World world = read("<model name='m'>" + links("a") + content + "</model>");
    return ground_drive(world.models[0]);
  }
  std::vector<DriveChannel> drive_of(const std::vector<Wheel>& wheels) const {
    std::string text;
    for (const Wheel& wheel : wheels) text += wheel_text(wheel);
    return drive_of(text);
  }
};

void expect_drive(const std::vector<DriveChannel>& drive, const std::vector<DriveChannel>& expected) {
  ASSERT_EQ(drive.size(), expected.size());
  for (std::size_t i = 0; i < drive.size(); ++i) {
    EXPECT_EQ(drive[i].channel, expected[i].channel);
    EXPECT_NEAR(drive[i].ahead, expected[i].ahead, rounding) << drive[i].channel;
    EXPECT_NEAR(drive[i].turn, expected[i].turn, rounding) << drive[i].channel;
  }
}

TEST_F(GroundDrives, HaveTheSidesOfTheWheelsWhateverTheirNames) {
  expect_drive(
      drive_of({{"right", 0.2, 0.3}, {"one", 0.2, -0.3}, {"two", -0.2, 0.3}, {"left", -0.2, -0.3}}),
      {{"right/0/velocity", 8, -8}, {"one/0/velocity", 8, 8}, {"two/0/velocity", 8, -8}, {"left/0/velocity", 8, 8}});
}

TEST_F(GroundDrives, TurnWheelsWhoseAxesPointToTheRightTheOtherWay) {
  expect_drive(drive_of({{"a1", 0, 0.3, "0 1 0"}, {"a2", 0, -0.3, "0 -1 0"}}),
               {{"a1/0/velocity", 8, -8}, {"a2/0/velocity", -8, -8}});
}

TEST_F(GroundDrives, HaveTheSidesOfTheMiddleBetweenTheWheels) {
  expect_drive(drive_of({{"a1", 0, 0.9}, {"a2", 0, 0.5}, {"a3", 0.3, 0.7}}),
               {{"a1/0/velocity", 8, -8}, {"a2/0/velocity", 8, 8}, {"a3/0/velocity", 8, 0}});
}

TEST_F(GroundDrives, TurnLargeWheelsSlower) {
  expect_drive(drive_of({{"a1", 0.3, 0.3, "0 1 0", 0.1, 0.1},
                         {"a2", 0.3, -0.3, "0 1 0", 0.1, 0.1},
                         {"b1", -0.3, 0.3, "0 1 0", 0.2, 0.2},
                         {"b2", -0.3, -0.3, "0 1 0", 0.2, 0.2}}),
               {{"a1/0/velocity", 8, -8}, {"a2/0/velocity", 8, 8}, {"b1/0/velocity", 4, -4}, {"b2/0/velocity", 4, 4}});
}

TEST_F(GroundDrives, GoAlongYIfTheAxesLieAlongX) {
  expect_drive(drive_of({{"a1", -0.3, 0, "1 0 0"}, {"a2", 0.3, 0, "1 0 0"}}),
               {{"a1/0/velocity", -8, 8}, {"a2/0/velocity", -8, -8}});
}

TEST_F(GroundDrives, LeaveOutJointsThatAreNoWheels) {
  const std::vector<Wheel> two = {{"a1", 0, 0.3}, {"a2", 0, -0.3}};
  const auto with = [&](const Wheel& other) {
    std::vector<Wheel> wheels = two;
    wheels.push_back(other);
    return drive_of(wheels);
  };
  const auto expected = drive_of(two);
  ASSERT_EQ(expected.size(), 2U);
  EXPECT_EQ(with({"turret", 0, 0, "0 0 1"}), expected);
  EXPECT_EQ(with({"flipper", 0.3, 0.3, "0 1 0", 0.1, 0.1, "<limit><lower>-1</lower><upper>1</upper></limit>"}),
            expected);
  EXPECT_EQ(with({"gimbal", 0.3, 0, "0 1 0", 0.1, 0.6}), expected) << "above the ground";
}

TEST_F(GroundDrives, AreNotThoseOfModelsWithoutTwoSides) {
  EXPECT_TRUE(drive_of({{"a1", 0, 0.3}}).empty());
  EXPECT_TRUE(drive_of({{"a1", 0.3, 0}, {"a2", -0.3, 0}}).empty()) << "a bicycle";
  EXPECT_TRUE(drive_of({{"a1", 0, 0.3}, {"a2", 0, -0.3}, {"a3", 0.3, 0, "1 0 0"}}).empty()) << "omnidirectional";
  EXPECT_TRUE(drive_of("").empty());
}

TEST_F(GroundDrives, HaveTheSidesOfTracks) {
  expect_drive(drive_of(belt_text("p", -0.3, "0 1 0") + belt_text("q", 0.3, "0 -1 0")),
               {{"p/0/velocity", 0.5, 0.5}, {"q/0/velocity", -0.5, 0.5}});
}

TEST_F(GroundDrives, TakeATwistInsteadOfWheels) {
  const std::string drive =
      "<cohort:tracked_drive name='tracks'><cohort:left_link>q</cohort:left_link><cohort:right_link>p"
      "</cohort:right_link><cohort:track_separation>0.6</cohort:track_separation><cohort:max_linear>0.5"
      "</cohort:max_linear><cohort:max_angular>2</cohort:max_angular></cohort:tracked_drive>";
  const World world = read("<model name='m'>" + links("apq") + joint("j", "a", "p", "<xyz>0 0 1</xyz>", "fixed") +
                           joint("k", "a", "q", "<xyz>0 0 1</xyz>", "fixed") + drive + wheel_text({"a1", 0, 0.3}) +
                           wheel_text({"a2", 0, -0.3}) + "</model>");
  Model model = world.models[0];
  const std::vector<DriveChannel> expected = {{"tracks/0/linear", 0.5, 0.0}, {"tracks/0/angular", 0.0, 2.0}};
  EXPECT_EQ(ground_drive(model), expected);
  for (Device& device : model.devices)
    if (auto* tracks = std::get_if<TrackedDrive>(&device))
      tracks->max_linear = tracks->max_angular = std::numeric_limits<double>::infinity();
  const std::vector<DriveChannel> without_limits = {{"tracks/0/linear", 1.0, 0.0}, {"tracks/0/angular", 0.0, 1.0}};
  EXPECT_EQ(ground_drive(model), without_limits);
}

TEST(GroundDrivesOfShippedModels, AreFoundWithoutTheirNames) {
  const auto drive_in = [](const std::string& experiment) {
    const auto read = parsing::read_experiment(source / "worlds/experiments" / (experiment + ".yaml"));
    return ground_drive(read.world.robot_model(0));
  };
  expect_drive(drive_in("teleop"), {{"treel/left/velocity", 0.2, -0.2}, {"treel/right/velocity", 0.2, 0.2}});
  expect_drive(drive_in("wheels"), {{"treel/left/velocity", 0.2, -0.2}, {"treel/right/velocity", 0.2, 0.2}});
  expect_drive(drive_in("kilobot"), {{"legs/left/velocity", 0.01, -0.01}, {"legs/right/velocity", 0.01, 0.01}});
  expect_drive(drive_in("turtlebot3"), {{"drive/0/linear", 0.22, 0}, {"drive/0/angular", 0, 2.84}});
  expect_drive(drive_in("arduino"), {{"left_wheel/0/velocity", 20, -20}, {"right_wheel/0/velocity", 20, 20}});
  expect_drive(drive_in("rover"), {{"left_wheel/0/velocity", 8, -8}, {"right_wheel/0/velocity", 8, 8}});
  EXPECT_EQ(drive_in("epuck2").size(), 2U);
  const std::vector<DriveChannel> legs = drive_in("hexapod");
  ASSERT_EQ(legs.size(), 6U);
  for (const DriveChannel& leg : legs) {
    // The axes of some legs point to the right.
    const double side = leg.channel.find("left") != std::string::npos ? -1.0 : 1.0;
    EXPECT_NEAR(leg.turn, side * leg.ahead, rounding) << leg.channel;
  }
  for (const char* undriven : {"arm", "quadcopters", "autopilot_boat"})
    EXPECT_TRUE(drive_in(undriven).empty()) << undriven;
}

}  // namespace
}  // namespace cohort::description
