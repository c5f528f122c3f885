// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests that a world or a model alone is an experiment without controllers.
namespace cohort::description {
namespace {

class WithoutExperiment : public Description {
 protected:
  /// The content of <model> starts on line 2.
  Experiment read_model(const std::string& content) const {
    return parsing::read_experiment(
        write("m.sdf", "<sdf version=\"1.9\"><model name=\"m\">\n" + content + "\n</model></sdf>\n"));
  }
};

std::string ball_at(double height) {
  return "<link name=\"l\"><pose>0 0 " + std::to_string(height) +
         " 0 0 0</pose><inertial><mass>1</mass></inertial><collision name=\"c\"><geometry><sphere><radius>0.5</radius>"
         "</sphere></geometry></collision></link>";
}

TEST_F(WithoutExperiment, AModelIsPlacedOnAPlane) {
  for (const double height : {-3.0, 0.0, 7.0}) {
    const Experiment experiment = read_model(ball_at(height));
    ASSERT_EQ(experiment.world.instances.size(), 2u);
    EXPECT_NEAR(experiment.world.instances[0].X_WM.position.z() + height, 0.501, 1e-9);
    EXPECT_EQ(experiment.world.instances[1].name, "ground");
  }
}

TEST_F(WithoutExperiment, AModelOfGroundIsNotMoved) {
  const Experiment experiment = read_model(
      "<static>1</static><link name=\"l\"><collision name=\"c\"><geometry><plane/></geometry></collision></link>");
  ASSERT_EQ(experiment.world.instances.size(), 1u);
  EXPECT_EQ(experiment.world.instances[0].X_WM.position.z(), 0.0);
}

TEST_F(WithoutExperiment, AModelWithoutCollisionsGetsAWarning) {
  const Experiment experiment = read_model("<link name=\"l\"><inertial><mass>1</mass></inertial></link>");
  EXPECT_EQ(experiment.world.instances.size(), 1u);
  EXPECT_NE(texts_of(experiment.world.warnings).find("model[m]: has no collisions, so it falls"), std::string::npos)
      << texts_of(experiment.world.warnings);
}

TEST_F(WithoutExperiment, RobotsAreInOneTeamWithoutController) {
  const Experiment experiment = parsing::read_experiment(write_world("<include><uri>model://sbot</uri></include>"), 7);
  EXPECT_EQ(experiment.seed, 7u);
  EXPECT_EQ(experiment.duration, std::chrono::seconds(10));
  ASSERT_EQ(experiment.teams.size(), 1u);
  EXPECT_EQ(experiment.teams[0].robots, (std::vector<std::uint32_t>{0}));
  EXPECT_FALSE(experiment.teams[0].policy.required);
  EXPECT_EQ(experiment.teams[0].controller, "");
}

TEST_F(WithoutExperiment, KeptFilesAreReadAgain) {
  const Experiment first = read_model(ball_at(1.0));
  std::filesystem::remove(folder_ / "m.sdf");
  const Experiment again = parsing::read_experiment(first.inputs, first.seed, first.duration);
  EXPECT_EQ(again.world.instances[0].X_WM.position, first.world.instances[0].X_WM.position);
}

TEST_F(WithoutExperiment, AFileIsRecognisedByItsContent) {
  const auto file = write(
      "m.model", "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\"><model name=\"m\">" + ball_at(1.0) + "</model></sdf>");
  EXPECT_EQ(parsing::read_experiment(file).world.instances.size(), 2u);
}

}  // namespace
}  // namespace cohort::description
