// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/keyboard.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tools/cli/running/team_controllers.hpp"

namespace cohort::tool {
namespace {

Start start_of_robot() {
  Start start;
  start.name = "r0";
  start.model = "sbot";
  start.command_channels = {{"treel/left/velocity", "m/s", 0, 1, -0.2, 0.2, 0.0},
                            {"treel/right/velocity", "m/s", 1, 1, -0.2, 0.2, 0.0},
                            {"turret/0/velocity", "rad/s", 2, 1, -1.5, 1.5, 0.0},
                            {"arm/0/position", "rad", 3, 1, 0.0, std::numeric_limits<double>::infinity(), 0.0}};
  return start;
}

std::vector<double> command_of(Controller& controller) {
  std::vector<double> values(4, 0.0);
  Command command(values);
  controller.step(Observation(3, std::chrono::milliseconds(30), {}), command);
  return values;
}

TEST(Keyboard, TheArrowsDriveTheTracksAndLettersTheOtherChannels) {
  Keyboard keyboard;
  const OwnedController controller = keyboard_controllers(keyboard).create();
  controller->start(start_of_robot());
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0, 0, 0, 0}));
  keyboard.press("up");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0.2, 0.2, 0, 0}));
  keyboard.press("f");
  keyboard.press("left");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{-0.1, 0.1, -1.5, 0}));
  keyboard.press("up");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0.2, 0.2, -1.5, 0})) << "the last key counts";
  keyboard.press("space");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0, 0, 0, 0}));
  EXPECT_EQ(keyboard.time(), std::chrono::milliseconds(30));
}

TEST(Keyboard, TheArrowsDriveWheelsOnBothSides) {
  Start start = start_of_robot();
  const std::vector<description::DriveChannel> wheels = {
      {"treel/right/velocity", -0.2, -0.2}, {"turret/0/velocity", 1.0, -1.0}, {"arm/0/position", 0.5, 0.0}};
  Keyboard keyboard;
  const OwnedController controller = keyboard_controllers(keyboard, [&](const Start&) { return wheels; }).create();
  controller->start(start);
  keyboard.press("up");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0, -0.2, 1.0, 0.5}));
  keyboard.press("left");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0, -0.1, -0.5, 0}));
  keyboard.press("down");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0, 0.2, -1.0, 0})) << "kept within the range of the channel";
  EXPECT_EQ(keyboard.bindings()[4].settings[0].channel, "treel/left/velocity") << "letters have the other channels";
}

TEST(Keyboard, TheArrowsDriveATwistInCurves) {
  Start start;
  start.command_channels = {{"drive/0/linear", "m/s", 0, 1, -0.5, 0.5, 0.0},
                            {"drive/0/angular", "rad/s", 1, 1, -2.0, 2.0, 0.0}};
  Keyboard keyboard;
  const OwnedController controller = keyboard_controllers(keyboard).create();
  controller->start(start);
  const auto command = [&] {
    std::vector<double> values(2, 0.0);
    Command set(values);
    controller->step(Observation(3, std::chrono::milliseconds(30), {}), set);
    return values;
  };
  keyboard.press("left");
  EXPECT_EQ(command(), (std::vector<double>{0, 1.0}));
  keyboard.press("up");
  EXPECT_EQ(command(), (std::vector<double>{0.5, 0.0})) << "straight";
  keyboard.press("right");
  EXPECT_EQ(command(), (std::vector<double>{0.5, -1.0})) << "a curve";
  keyboard.press("space");
  EXPECT_EQ(command(), (std::vector<double>{0, 0}));
}

TEST(Keyboard, RobotsWithoutADriveHaveNoArrows) {
  Start start;
  start.command_channels = {{"lift/0/velocity", "rad/s", 0, 1, -1.0, 1.0, 0.0}};
  EXPECT_TRUE(drive_without_model(start).empty());
  EXPECT_EQ(key_bindings(start, {}).front().key, "r");
}

TEST(Keyboard, PlusAndMinusChangeTheShareWithinATenthAndTheWhole) {
  Keyboard keyboard;
  const OwnedController controller = keyboard_controllers(keyboard).create();
  controller->start(start_of_robot());
  keyboard.press("r");
  for (int i = 0; i < 5; ++i) keyboard.press("-");
  EXPECT_DOUBLE_EQ(command_of(*controller)[2], 0.75);
  for (int i = 0; i < 20; ++i) keyboard.press("-");
  EXPECT_DOUBLE_EQ(command_of(*controller)[2], 0.15);
  for (int i = 0; i < 20; ++i) keyboard.press("+");
  EXPECT_DOUBLE_EQ(command_of(*controller)[2], 1.5);
}

TEST(Keyboard, AnExperimentBindsKeysOfItsOwn) {
  Start start = start_of_robot();
  start.controller = keyboard_controller;
  start.parameters =
      Parameters({{"up.treel/left/velocity", {"0.1"}}, {"up.arm/0/position", {"2"}}, {"x.turret/0/velocity", {"-1"}}});
  Keyboard keyboard;
  const OwnedController controller = keyboard_controllers(keyboard).create();
  controller->start(start);
  EXPECT_NO_THROW(start.parameters.check_all_were_asked_for());
  keyboard.press("up");
  keyboard.press("x");
  keyboard.press("down");
  EXPECT_EQ(command_of(*controller), (std::vector<double>{0.1, 0, -1, 2}));
}

TEST(Keyboard, WrongBindingsAreExplained) {
  const auto message = [](Parameter parameter) -> std::string {
    Start start = start_of_robot();
    start.controller = keyboard_controller;
    start.parameters = Parameters(std::vector{std::move(parameter)});
    try {
      key_bindings(start, {});
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({"up", {"1"}}).find("'CHANNEL: VALUE' under a key"), std::string::npos);
  EXPECT_NE(message({"q.turret/0/velocity", {"1"}}).find("not a valid key"), std::string::npos);
  EXPECT_NE(message({"up.turret/0/velocty", {"1"}}).find("the nearest are turret/0/velocity"), std::string::npos);
  EXPECT_NE(message({"up.turret/0/velocity", {"2"}}).find("at most 1.5"), std::string::npos);
}

TEST(Keyboard, ParametersOfAnotherControllerAreLeftToIt) {
  Start start = start_of_robot();
  start.controller = "braitenberg";
  start.parameters = Parameters(std::vector{Parameter{"treel/left/velocity.bias", {"0.2"}}});
  EXPECT_EQ(key_bindings(start, drive_without_model(start)).front().key, "up");
  EXPECT_NO_THROW(start.parameters.check_all_were_asked_for());
}

}  // namespace
}  // namespace cohort::tool
