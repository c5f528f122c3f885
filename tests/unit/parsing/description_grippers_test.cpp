// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

std::string robot(const std::string& devices, const std::string& in_arm = "", const std::string& in_collision = "") {
  const std::string inertial =
      "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";
  return "<model name=\"m\"><link name=\"base\">" + inertial + "</link><link name=\"arm\">" + inertial +
         "<collision name=\"c\"><geometry><sphere><radius>0.1</radius></sphere></geometry>" + in_collision +
         "</collision>" + in_arm +
         "</link><joint name=\"elevation\" type=\"revolute\"><parent>base</parent><child>arm</child>"
         "<axis><xyz>0 1 0</xyz></axis></joint>\n" +
         devices + "</model>";
}

const std::string gripper =
    "<cohort:gripper name=\"g\"><cohort:link>arm</cohort:link><cohort:pose>0.1 0 0 0 0 0</cohort:pose>"
    "<cohort:depth>0.02</cohort:depth><cohort:half_angle>0.8</cohort:half_angle><cohort:height>0.01</cohort:height>"
    "<cohort:holding_force>30</cohort:holding_force><cohort:breaking_torque>2</cohort:breaking_torque>"
    "<cohort:light_barrier>beam</cohort:light_barrier></cohort:gripper>";

using Grippers = Description;

TEST_F(Grippers, AreReadWithGrippableObjects) {
  const World world = read(robot(gripper,
                                 "<cohort:grip_ring name=\"r\"><cohort:pose>0 0 0.02 0 0 0</cohort:pose>"
                                 "<cohort:radius>0.06</cohort:radius></cohort:grip_ring>",
                                 "<cohort:grippable>true</cohort:grippable>"));
  const Model& model = world.models[0];
  const auto& read = std::get<Gripper>(model.devices.at(0));
  EXPECT_EQ(read.link, 1u);
  EXPECT_EQ(read.X_LG.position.x(), 0.1);
  EXPECT_EQ(read.depth, 0.02);
  EXPECT_EQ(read.half_angle, 0.8);
  EXPECT_EQ(read.height, 0.01);
  EXPECT_EQ(read.closing_time, 0.5);
  EXPECT_EQ(read.holding_force, 30.0);
  EXPECT_EQ(read.holding_torque, 3.0);
  EXPECT_TRUE(std::isinf(read.breaking_force));
  EXPECT_EQ(read.breaking_torque, 2.0);
  EXPECT_EQ(read.light_barrier, Gripper::LightBarrier::beam);
  ASSERT_EQ(model.grip_rings.size(), 1u);
  EXPECT_EQ(model.grip_rings[0].link, 1u);
  EXPECT_EQ(model.grip_rings[0].X_LR.position.z(), 0.02);
  EXPECT_EQ(model.grip_rings[0].radius, 0.06);
  EXPECT_TRUE(model.links[1].collisions[0].surface.is_grippable);
}

TEST_F(Grippers, ReadMotorsAndForceSensorsWithRotorInertia) {
  const World world =
      read(robot("<cohort:position_motor "
                 "name=\"p\"><cohort:joint>elevation</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
                 "<cohort:max_effort>2</cohort:max_effort><cohort:rotor_inertia>0.002</cohort:rotor_inertia></"
                 "cohort:position_motor>"
                 "<cohort:torque_sensor name=\"t\"><cohort:joint>elevation</cohort:joint></cohort:torque_sensor>"
                 "<cohort:traction_sensor name=\"f\"><cohort:joint>elevation</cohort:joint></cohort:traction_sensor>"));
  const auto& motor = std::get<PositionMotor>(world.models[0].devices.at(0));
  EXPECT_EQ(motor.max_velocity, 1.0);
  EXPECT_EQ(motor.max_effort, 2.0);
  EXPECT_EQ(motor.rotor_inertia, 0.002);
  EXPECT_EQ(std::get<TorqueSensor>(world.models[0].devices.at(1)).joint, 0u);
  EXPECT_EQ(std::get<TractionSensor>(world.models[0].devices.at(2)).joint, 0u);
}

TEST_F(Grippers, ReportProblemsWithASuggestion) {
  const auto problems = problems_of([&] {
    read(
        robot("<cohort:effort_motor name=\"e\"><cohort:joint>elevaton</cohort:joint>"
              "<cohort:max_effort>2</cohort:max_effort></cohort:effort_motor>"));
  });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("elevation"), std::string::npos) << problems[0].message;
}

TEST_F(Grippers, AreWrittenUnchanged) {
  const World first =
      read(robot(gripper, "<cohort:grip_ring name=\"r\"><cohort:radius>0.06</cohort:radius></cohort:grip_ring>",
                 "<cohort:grippable>true</cohort:grippable>"));
  const std::string text = parsing::xml_text(parsing::sdf_of(first, folder_));
  const World second = parsing::read_world(write("again.sdf", text), 1);
  EXPECT_EQ(parsing::xml_text(parsing::sdf_of(second, folder_)), text);
  EXPECT_EQ(second.models[0].grip_rings.size(), 1u);
  EXPECT_TRUE(second.models[0].links[1].collisions[0].surface.is_grippable);
}

}  // namespace
}  // namespace cohort::description
