// SPDX-License-Identifier: Apache-2.0
#include "server/placement/with_seed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/experiment_text.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

namespace fs = std::filesystem;
using parsing::read_experiment;
using placement::with_seed;

// Reads the kept files of an experiment again.
Experiment read_with(const Experiment& experiment, std::uint64_t seed) {
  return read_experiment(experiment.inputs, seed, experiment.duration);
}

// Returns the text of an experiment, or its problems.
template <class Make>
std::string result_of(const Make& make) {
  std::string text;
  const std::vector<Problem> problems = problems_of([&] { text = test::text_of(make()); });
  return problems.empty() ? text : texts_of(problems);
}

class ShippedFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(ShippedFile, IsPlacedInMemoryAsWhenItIsReadWithTheSeed) {
  const Experiment first = read_experiment(GetParam());
  const std::uint64_t seeds = first.world.populations.empty() ? 1 : 20;
  for (std::uint64_t seed = 100; seed < 100 + seeds; ++seed)
    ASSERT_EQ(test::text_of(with_seed(first, seed)), test::text_of(read_with(first, seed)));
  EXPECT_EQ(test::text_of(with_seed(with_seed(first, 3), first.seed)), test::text_of(first));
}

std::vector<fs::path> shipped_files() {
  std::vector<fs::path> files;
  for (const char* const folder : {"worlds/experiments", "worlds/arenas"})
    for (const fs::directory_entry& entry : fs::directory_iterator(source / folder))
      if (entry.path().extension() == ".yaml" || entry.path().extension() == ".sdf") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedFile, ::testing::ValuesIn(shipped_files()), [](const auto& each) {
  std::string name = each.param.parent_path().filename().string() + "_" + each.param.stem().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

class WithSeed : public Description {
 protected:
  static std::string population(const std::string& name, int count, const std::string& placement,
                                bool may_be_fewer = true, const std::string& uri = "model://sbot") {
    return "<cohort:population name='" + name + "'><cohort:uri>" + uri + "</cohort:uri><cohort:count>" +
           std::to_string(count) + "</cohort:count><cohort:may_be_fewer>" + (may_be_fewer ? "true" : "false") +
           "</cohort:may_be_fewer><cohort:placement>" + placement + "</cohort:placement></cohort:population>\n";
  }
  static std::string uniform(const std::string& half) {
    return "<cohort:uniform><cohort:min>-" + half + " -" + half + "</cohort:min><cohort:max>" + half + " " + half +
           "</cohort:max></cohort:uniform>";
  }
  // Returns a world with as many posts as fit, and robots at fixed positions that posts can block.
  std::string world_of_fewer() const {
    write_model("post",
                "<static>true</static>" + collision("<cylinder><radius>0.05</radius><length>0.3</length></cylinder>"));
    const std::string cable = "<model name='cable'>" + links("a") +
                              "<plugin filename='gz-sim-detachable-joint-system' "
                              "name='gz::sim::systems::DetachableJoint'><parent_link>a</parent_link>"
                              "<child_model>posts/post_13</child_model><child_link>l</child_link></plugin></model>";
    return static_model_sdf(collision("<plane/>"), "ground") + cable +
           population("posts", 14, uniform("0.5"), true, "model://post") +
           population("bots", 9, "<cohort:grid><cohort:spacing>0.4</cohort:spacing></cohort:grid>") +
           population(
               "turned", 3,
               "<cohort:formation><cohort:center>0.3 0</cohort:center><cohort:pattern>wedge</cohort:pattern>"
               "<cohort:spacing>0.5</cohort:spacing></cohort:formation><cohort:heading>random</cohort:heading>") +
           population("far", 3,
                      "<cohort:gaussian><cohort:center>5 5</cohort:center><cohort:deviation>1</cohort:deviation>"
                      "</cohort:gaussian>",
                      false) +
           "<cohort:breakable_joint name='j'><cohort:first>far/sbot_0</cohort:first>"
           "<cohort:second>ground</cohort:second></cohort:breakable_joint>";
  }
  Experiment read_fewer(const std::string& more = "") const {
    write_world(world_of_fewer());
    return read_experiment(write("e.yaml",
                                 "world: world.sdf\nduration: 1\n"
                                 "teams:\n"
                                 "  - {name: bots, robots: 'bots/*', controller: x}\n"
                                 "  - {name: far, robots: 'far/*', controller: x}\n"
                                 "  - {name: others, robots: ['turned/*', cable], controller: x}\n"
                                 "events:\n"
                                 "  - {at: 0.5, remove: {objects: 'bots/*'}}\n"
                                 "  - {at: 0.4, add: {model: 'model://post', name: late, pose: 8 8 0 0 0 0}}\n"
                                 "  - {at: 0.6, remove: {objects: late}}\n"
                                 "stop:\n  - at_rest: {objects: 'far/*'}\n"
                                 "print:\n  - {quantity: position, objects: 'far/*', every: 0.1}\n"
                                 "history: {objects: 'far/*', length: 5}\n" +
                                     more));
  }
};

TEST_F(WithSeed, PopulationsThatMayBeFewerAreAsReadAndSoIsAllThatNamesThem) {
  for (const char* const more : {"", "record: {robots: 'far/*'}\n"}) {
    const Experiment first = read_fewer(more);
    std::set<std::size_t> counts;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const std::string read = result_of([&] { return read_with(first, seed); });
      ASSERT_EQ(result_of([&] { return with_seed(first, seed); }), read);
      problems_of([&] {
        const Experiment other = with_seed(first, 1000 + seed);
        counts.insert(other.world.robots.size());
        EXPECT_EQ(result_of([&] { return with_seed(other, seed); }), read);
      });
    }
    EXPECT_GT(counts.size(), 2u);
  }
}

TEST_F(WithSeed, WhatWasSetSinceReadingStays) {
  Experiment first = read_fewer();
  first.recorded.pose_rate = 3.0;
  first.recorded.selectors = {"bots/*"};
  first.world.physics.iterations = 17;
  first.teams[0].policy.period = 5;
  std::uint64_t seed = 1;
  std::optional<Experiment> found;
  while (!found || found->world.robots.size() == first.world.robots.size())
    problems_of([&] { found = with_seed(first, ++seed); });
  const Experiment& other = *found;
  EXPECT_EQ(other.seed, seed);
  EXPECT_EQ(other.recorded.pose_rate, 3.0);
  EXPECT_EQ(other.recorded.observed, other.teams[0].robots);
  EXPECT_EQ(other.world.physics.iterations, 17u);
  EXPECT_EQ(other.teams[0].policy.period, 5u);
  EXPECT_EQ(other.inputs, first.inputs);
}

TEST_F(WithSeed, AWorldWithoutAnExperimentHasOneTeamOfAllItsRobots) {
  const Experiment first = read_experiment(write_world(world_of_fewer()));
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    ASSERT_EQ(test::text_of(with_seed(first, seed)), test::text_of(read_with(first, seed)));
}

// Checks every seed that has problems.
void expect_same_problems(const Experiment& first) {
  std::set<std::string> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::string expected = texts_of(problems_of([&] { read_with(first, seed); }));
    ASSERT_EQ(texts_of(problems_of([&] { with_seed(first, seed); })), expected);
    seen.insert(expected);
  }
  EXPECT_GT(seen.size(), 1u) << "no seed has a problem";
}

TEST_F(WithSeed, WhatHasNoRoomIsReportedAsByReading) {
  write_world(population("p", 14, "\n" + uniform("0.25"), false));
  const fs::path file =
      write("e.yaml", "world: world.sdf\nduration: 1\nteams: [{name: t, robots: all, controller: x}]\n");
  std::optional<Experiment> first;
  for (std::uint64_t seed = 0; !first && seed < 1000; ++seed) problems_of([&] { first = read_experiment(file, seed); });
  ASSERT_TRUE(first) << "no seed has room for all";
  expect_same_problems(*first);
}

TEST_F(WithSeed, WhatTheExperimentNamesAndIsNotThereIsReportedAsByReading) {
  const std::string some =
      "<cohort:breakable_joint name='k'><cohort:first>bots/sbot_4</cohort:first>"
      "<cohort:second>\nground</cohort:second></cohort:breakable_joint>";
  const auto experiment_that_names = [&](const std::string& world, const std::string& more) {
    std::optional<Experiment> first;
    write_world(world_of_fewer() + world);
    const fs::path file =
        write("e.yaml", "world: world.sdf\nduration: 1\nteams: [{name: t, robots: all, controller: x}]\n" + more);
    for (std::uint64_t seed = 0; !first && seed < 100; ++seed)
      problems_of([&] { first = read_experiment(file, seed); });
    return first;
  };
  const auto by_joint = experiment_that_names(some, "");
  ASSERT_TRUE(by_joint);
  expect_same_problems(*by_joint);
  const auto by_event = experiment_that_names("", "print: [{quantity: pose, objects: bots/sbot_4, every: 0.1}]\n");
  ASSERT_TRUE(by_event);
  expect_same_problems(*by_event);
  const auto by_id = experiment_that_names("", "record: {robots: 9}\n");
  ASSERT_TRUE(by_id);
  expect_same_problems(*by_id);
}

}  // namespace
}  // namespace cohort::description
