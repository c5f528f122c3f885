// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/yaml/setting.hpp"
#include "tests/support/files.hpp"

// Values that replace those of an experiment and its world, as PATH=VALUE.
namespace cohort::parsing {
namespace {

using Settings = std::vector<std::string>;

const std::filesystem::path models = COHORT_SOURCE_DIR "/worlds/robots";

constexpr const char* world_in_yaml = R"(world:
  gravity: [0, 0, -9.81]
  model:
    - {name: floor, static: true, link: {collision: {geometry: {plane: {}}}}}
    - {name: stone, pose: [1, 0, 1, 0, 0, 0], link: {collision: {geometry: {sphere: {radius: 0.1}}}}}
  include: [{uri: model://sbot, name: digger}, {uri: model://sbot, name: carrier, pose: [0, 1, 0, 0, 0, 0]}]
  cohort:population:
    - name: stones
      uri: stone.yaml
      count: 2
      placement: {uniform: {min: [-1, -1], max: [1, 1]}}
)";

constexpr const char* world_in_sdf = R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">
  <world name="default">
    <gravity>0 0 -9.81</gravity>
    <model name="floor">
      <static>true</static>
      <link name="link"><collision name="c"><geometry><plane/></geometry></collision></link>
    </model>
    <model name="stone">
      <pose>1 0 1 0 0 0</pose>
      <link name="link">
        <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      </link>
    </model>
    <include><uri>model://sbot</uri><name>digger</name></include>
    <include><uri>model://sbot</uri><name>carrier</name><pose>0 1 0 0 0 0</pose></include>
  </world>
</sdf>
)";

constexpr const char* experiment = R"(world: WORLD
duration: 5
teams:
  - name: diggers
    robots: digger
    controller: obstacle_avoidance
    parameters: {gain: 1.5}
  - {name: carriers, robots: carrier, controller: obstacle_avoidance}
)";

class SettingsOfExperiments : public testing::TestWithParam<const char*> {
 protected:
  SettingsOfExperiments() {
    test::write_file(folder_ / "world.yaml", world_in_yaml);
    test::write_file(folder_ / "world.sdf", world_in_sdf);
    test::write_file(folder_ / "stone.yaml",
                     "model: {name: stone, link: {collision: {geometry: {sphere: {radius: 0.05}}}}}\n");
    std::string text = experiment;
    test::write_file(folder_ / "run.yaml", text.replace(text.find("WORLD"), 5, GetParam()));
  }
  description::Experiment read(const Settings& settings) const {
    return read_experiment(folder_ / "run.yaml", {}, {}, {models}, Xacro::refused, settings);
  }
  std::string problems_with(const std::string& setting) const {
    try {
      read({setting});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::ScratchFolder folder_;
};

TEST_P(SettingsOfExperiments, ReplaceValuesOfTheWorld) {
  const World world = read({"world.gravity=[0, 0, -1.6]", "world.model.stone.pose=[2, 0, 3, 0, 0, 0]",
                            "world.model.stone.link.collision.geometry.sphere.radius=0.25"})
                          .world;
  EXPECT_EQ(world.gravity, Eigen::Vector3d(0.0, 0.0, -1.6));
  EXPECT_EQ(world.instances[1].X_WM.position, Eigen::Vector3d(2.0, 0.0, 3.0));
  const description::Model& stone = world.models[world.instances[1].model];
  EXPECT_EQ(std::get<description::Sphere>(stone.links[0].collisions[0].shape).radius, 0.25);
}

TEST_P(SettingsOfExperiments, AddWhatTheWorldDoesNotHave) {
  const World world = read({"world.model.stone.static=true"}).world;
  EXPECT_TRUE(world.models[world.instances[1].model].is_static);
}

TEST_P(SettingsOfExperiments, ReplaceValuesOfTeamsByNameOrIndex) {
  const description::Experiment read_again =
      read({"duration=7", "teams.diggers.parameters.gain=2", "teams.1.parameters.depth=0.5"});
  EXPECT_EQ(read_again.duration, std::chrono::seconds(7));
  const auto gain = [](const description::Team& team) { return team.parameters.at(0).values; };
  EXPECT_EQ(gain(read_again.teams[0]), Settings{"2"});
  EXPECT_EQ(gain(read({"teams.0.parameters={gain: 3}"}).teams[0]), Settings{"3"});
  EXPECT_EQ(read_again.teams[1].parameters.at(0).name, "depth");
}

TEST_P(SettingsOfExperiments, AreKeptWithTheFiles) {
  const description::Experiment changed = read({"world.gravity=[0, 0, -3.7]", "teams.diggers.period=4"});
  const description::Experiment again = read_experiment(changed.inputs, {}, {});
  EXPECT_EQ(again.world.gravity.z(), -3.7);
  EXPECT_EQ(again.teams[0].policy.period, 4u);
}

TEST_P(SettingsOfExperiments, NameTheNearestForAMisspelling) {
  EXPECT_NE(problems_with("teams.digers.period=2").find("there is no item 'digers'; did you mean 'diggers'?"),
            std::string::npos)
      << problems_with("teams.digers.period=2");
  EXPECT_NE(problems_with("teams.diggers.perod=2").find("did you mean 'period'?"), std::string::npos)
      << problems_with("teams.diggers.perod=2");
  EXPECT_NE(problems_with("world.model.ston.static=true").find("no <model> named 'ston'; did you mean 'stone'?"),
            std::string::npos)
      << problems_with("world.model.ston.static=true");
  EXPECT_NE(problems_with("world.gravty=[0, 0, 0]").find("did you mean 'gravity'?"), std::string::npos)
      << problems_with("world.gravty=[0, 0, 0]");
  EXPECT_NE(problems_with("world.model.stone.static.x=1").find("static"), std::string::npos)
      << problems_with("world.model.stone.static.x=1");
}

TEST_P(SettingsOfExperiments, NameTheFileAndTheLine) {
  EXPECT_NE(problems_with("duration.seconds=2").find("run.yaml:2: duration.seconds: cannot be set, since '5' has no"),
            std::string::npos)
      << problems_with("duration.seconds=2");
}

INSTANTIATE_TEST_SUITE_P(Formats, SettingsOfExperiments, testing::Values("world.yaml", "world.sdf"),
                         [](const auto& each) { return std::string(each.param).substr(6); });

TEST(Settings, OfAPopulationNeedNoPrefix) {
  const test::ScratchFolder folder;
  test::write_file(folder / "world.yaml", world_in_yaml);
  test::write_file(folder / "stone.yaml",
                   "model: {name: stone, link: {collision: {geometry: {sphere: {radius: 0.05}}}}}\n");
  const auto count_with = [&](const Settings& settings) {
    return read_experiment(folder / "world.yaml", {}, {}, {models}, Xacro::refused, settings).world.instances.size();
  };
  EXPECT_EQ(count_with({}), 6u);
  EXPECT_EQ(count_with({"world.population.stones.count=5"}), 9u);
  EXPECT_EQ(count_with({"world.cohort:population.stones.count=5"}), 9u);
}

TEST(Settings, OfAnotherFormAreRefused) {
  for (const char* const text : {"", "gain", "=2", "teams..gain=2", "teams.\"a.gain=2", "gain=", "gain=[1"})
    EXPECT_THROW(parse_setting(text), std::invalid_argument) << text;
}

TEST(Settings, QuoteStepsWithDots) {
  const Setting setting = parse_setting(R"(teams."a.b".parameters.text="x=1")");
  EXPECT_EQ(setting.path, (Settings{"teams", "a.b", "parameters", "text"}));
  EXPECT_EQ(setting.value->text, "x=1");
}

}  // namespace
}  // namespace cohort::parsing
