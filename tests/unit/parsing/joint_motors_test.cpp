// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// A model that is shown by itself has a position motor on each joint, so that a person can move it.
namespace cohort::description {
namespace {

class JointMotors : public Description {
 protected:
  static std::string link(const std::string& name, double height, const std::string& more = "") {
    return "<link name=\"" + name + "\"><pose>0 0 " + std::to_string(height) +
           " 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.05</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia>"
           "</inertial>" +
           more + "</link>\n";
  }
  /// On a base that is tied to the world: a joint that turns, one that slides and one that is fixed.
  static std::string arm() {
    const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& axis) {
      return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent>" + parent + "</parent><child>" + child +
             "</child>" + axis + "</joint>\n";
    };
    const std::string limits = "<limit><lower>-1</lower><upper>0.8</upper></limit>";
    return link("base", 0.1,
                "<collision name=\"c\"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>") +
           link("upper", 0.3) + link("slide", 0.5) + link("tip", 0.6) + joint("tie", "fixed", "world", "base", "") +
           joint("a<b", "revolute", "base", "upper", "<axis><xyz>0 1 0</xyz>" + limits + "</axis>") +
           joint("rail", "prismatic", "upper", "slide", "<axis><xyz>0 0 1</xyz>" + limits + "</axis>") +
           joint("weld", "fixed", "slide", "tip", "");
  }
  Experiment read(const std::string& content) const {
    return parsing::read_experiment_with_joint_motors(
        write("m.sdf", "<sdf version=\"1.9\" xmlns:cohort=\"https://cohort-sim.org/sdf/1\"><model name=\"m\">\n" +
                           content + "\n</model></sdf>\n"));
  }
};

TEST_F(JointMotors, TakeJointsToThePositionsThatAreCommanded) {
  std::string text = arm();
  while (text.find("a<b") != std::string::npos) text.replace(text.find("a<b"), 3, "a&lt;b");
  const Experiment experiment = read(text);
  ASSERT_EQ(experiment.world.robots.size(), 1u) << texts_of(experiment.world.warnings);
  Simulation simulation(experiment, 1);
  const std::vector<Channel>& channels = simulation.kinds()[0].command;
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0].name, "a<b/0/position");
  EXPECT_EQ(channels[0].unit, "rad");
  EXPECT_EQ(channels[0].upper, 0.8);
  EXPECT_EQ(channels[1].name, "rail/0/position");
  EXPECT_EQ(channels[1].unit, "m");
  const std::array<double, 2> wanted = {0.5, -0.3};
  simulation.set_command(0, wanted);
  for (int step = 0; step < 300; ++step) simulation.step();
  const Model& model = experiment.world.robot_model(0);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const double position = simulation.world().joint_state(simulation.body_of(0), JointId{i}).position;
    const double expected = model.joints[i].name == "a<b" ? 0.5 : model.joints[i].name == "rail" ? -0.3 : 0.0;
    EXPECT_NEAR(position, expected, 0.01) << model.joints[i].name;
  }
}

TEST_F(JointMotors, AreReadAgainFromWhatARecordingKeeps) {
  std::string text = arm();
  while (text.find("a<b") != std::string::npos) text.replace(text.find("a<b"), 3, "turn");
  const Experiment experiment = read(text);
  const Experiment again = parsing::read_experiment(experiment.inputs, experiment.seed, experiment.duration);
  EXPECT_EQ(Simulation(again, 1).state_hash(), Simulation(experiment, 1).state_hash());
  EXPECT_EQ(again.world.robots.size(), 1u);
}

TEST_F(JointMotors, AreNotAddedToAModelThatHasAMotorOrNoJoint) {
  std::string text = arm();
  while (text.find("a<b") != std::string::npos) text.replace(text.find("a<b"), 3, "turn");
  const Experiment driven = read(text +
                                 "<cohort:velocity_motor name=\"own\"><cohort:joint>turn</cohort:joint>"
                                 "<cohort:max_velocity>1</cohort:max_velocity><cohort:max_effort>1</cohort:max_effort>"
                                 "</cohort:velocity_motor>");
  EXPECT_EQ(driven.world.robot_model(0).devices.size(), 1u);
  EXPECT_TRUE(read(link("l", 1.0)).world.robots.empty());
}

}  // namespace
}  // namespace cohort::description
