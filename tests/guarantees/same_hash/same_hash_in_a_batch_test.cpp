// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "server/batch/batch.hpp"
#include "server/parsing/experiment/read_experiment.hpp"

namespace cohort::test {
namespace {

constexpr std::uint64_t ticks_held = 3;  // commands are, in a row

std::filesystem::path path_of(const std::string& name) {
  if (name == "every_device") return COHORT_SOURCE_DIR "/tests/data/every_device/experiment.yaml";
  return COHORT_SOURCE_DIR "/worlds/experiments/" + name + ".yaml";
}

// Returns a function of seed, tick and robot, within the channel's range and 1 around zero.
std::vector<double> command_for(const RobotKind& kind, std::uint64_t seed, std::uint64_t tick, std::uint32_t robot) {
  std::vector<double> values;
  const double phase = 0.013 * static_cast<double>(tick) + robot + static_cast<double>(seed);
  for (const Channel& channel : kind.command) {
    const double lower = std::max(channel.lower, -1.0), upper = std::min(channel.upper, 1.0);
    const double middle = 0.5 * (lower + upper), reach = 0.25 * (upper - lower);
    for (std::uint32_t i = 0; i < channel.size; ++i)
      values.push_back(middle + reach * std::sin(phase + static_cast<double>(values.size())));
  }
  return values;
}

// Single runs of the experiment with a seed each, and their hash at each tick at which commands change.
class RunsAlone {
 public:
  explicit RunsAlone(const std::string& name) : name_(name) {}

  std::uint64_t hash(std::uint64_t seed, std::uint64_t tick) {
    std::map<std::uint64_t, std::uint64_t>& known = hashes_[seed];
    if (!known.contains(tick)) known = run(seed, std::max(tick, std::uint64_t{30}));
    return known.at(tick);
  }

 private:
  std::map<std::uint64_t, std::uint64_t> run(std::uint64_t seed, std::uint64_t ticks) const {
    Simulation alone(parsing::read_experiment(path_of(name_), seed), 1);
    std::map<std::uint64_t, std::uint64_t> hashes{{0, alone.state_hash()}};
    while (alone.tick() < ticks && !alone.stop_reason()) {
      if (alone.tick() % ticks_held == 0)
        for (std::uint32_t robot = 0; robot < alone.robot_count(); ++robot)
          alone.set_command(robot, command_for(alone.kinds()[alone.kind_of(robot)], seed, alone.tick(), robot));
      alone.step();
      hashes[alone.tick()] = alone.state_hash();
    }
    return hashes;
  }

  std::string name_;
  std::map<std::uint64_t, std::map<std::uint64_t, std::uint64_t>> hashes_;  // by seed
};

class SameHashInABatch : public ::testing::TestWithParam<std::string> {
 protected:
  // Worlds that are reset at different times, in a mixed order, to seeds that other worlds have too.
  void expect_those_of_runs_alone(std::size_t worlds, unsigned threads) {
    Batch batch(experiment_, worlds, threads);
    std::vector<std::uint64_t> seeds(worlds, experiment_.seed);
    const auto begin_anew = [&](std::size_t world, std::uint64_t seed) {
      batch.reset(world, seed);
      seeds[world] = seed;
    };
    for (std::size_t world = worlds; world-- > 1;) begin_anew(world, experiment_.seed + world % 3);
    for (int round = 0; round < 8; ++round) {
      for (std::size_t world = 0; world < worlds; ++world)
        ASSERT_EQ(batch.hash(world), alone_.hash(seeds[world], batch.tick(world)))
            << "world " << world << ", seed " << seeds[world] << ", tick " << batch.tick(world) << ", " << worlds
            << " worlds, " << threads << " threads";
      if (round == 3) begin_anew(worlds - 1, experiment_.seed + 1);
      if (round == 5) begin_anew(0, experiment_.seed + 2);
      command(batch, seeds);
      batch.step(ticks_held);
    }
  }

  void command(Batch& batch, const std::vector<std::uint64_t>& seeds) const {
    for (std::size_t world = 0; world < batch.worlds(); ++world)
      for (std::uint32_t robot = 0; robot < batch.robots(); ++robot) {
        const std::vector<double> values =
            command_for(batch.kinds()[batch.kind_of(robot)], seeds[world], batch.tick(world), robot);
        std::ranges::copy(values,
                          batch.commands().subspan((world * batch.robots() + robot) * batch.command_size()).begin());
      }
  }

  description::Experiment experiment_ = parsing::read_experiment(path_of(GetParam()));
  RunsAlone alone_{GetParam()};
};

TEST_P(SameHashInABatch, AsInASingleRunForAnyThreadsWorldsAndResets) {
  expect_those_of_runs_alone(1, 1);
  expect_those_of_runs_alone(5, 1);
  expect_those_of_runs_alone(5, 2);
}
INSTANTIATE_TEST_SUITE_P(Experiments, SameHashInABatch,
                         ::testing::Values("every_device", "obstacle_avoidance", "changes", "gate", "plane", "lifting",
                                           "quadcopters", "rough_terrain", "step", "formation"),
                         [](const auto& experiment) { return experiment.param; });

}  // namespace
}  // namespace cohort::test
