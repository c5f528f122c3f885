// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"

/// A snapshot with an invalid value is rejected. With any other change the run continues for its next ticks, with other
/// bits or with a quarantined body.
namespace cohort {
namespace {

using description::Dynamics;
using description::Fidelity;

struct Case {
  std::string name;
  Fidelity fidelity = Fidelity::articulated;
  Dynamics dynamics = Dynamics::bullet;
};

class ChangedSnapshot : public testing::TestWithParam<Case> {
 protected:
  ChangedSnapshot()
      : experiment_(parsing::read_experiment(std::filesystem::path(COHORT_SOURCE_DIR "/worlds/experiments") /
                                             (GetParam().name + ".yaml"))) {
    if (GetParam().fidelity == Fidelity::planar) experiment_.world.physics.fidelity = Fidelity::planar;
    experiment_.world.physics.dynamics = GetParam().dynamics;
  }

  // Robots do this and that for a second, so that they touch, grip and have drawn numbers.
  std::vector<std::byte> snapshot() {
    Simulation simulation(experiment_, 1);
    for (int tick = 0; tick < 100; ++tick) {
      for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
        std::vector<double> command;
        for (const Channel& channel : simulation.kinds()[simulation.kind_of(robot)].command)
          for (std::uint32_t i = 0; i < channel.size; ++i) {
            const double lower = std::max(channel.lower, -1.0), upper = std::min(channel.upper, 1.0);
            command.push_back(lower > upper ? channel.neutral : std::uniform_real_distribution(lower, upper)(random_));
          }
        simulation.set_command(robot, command);
      }
      simulation.step();
    }
    return simulation.save();
  }

  void change(std::vector<std::byte>& bytes) {
    const auto put = [&](const auto& number) {
      const std::size_t at = std::uniform_int_distribution<std::size_t>(0, bytes.size() - sizeof number)(random_);
      std::memcpy(bytes.data() + at, &number, sizeof number);
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    constexpr double numbers[] = {nan, infinity, -infinity, 1e300, -1e300, 1e18, -1e9, 1e5, 3.0, -0.5, 1e-300};
    constexpr std::uint32_t counts[] = {0, 1, 2, 100, 0x7fffffff, 0xfffffffe, 0xffffffff};
    switch (std::uniform_int_distribution(0, 2)(random_)) {
      case 0: put(numbers[std::uniform_int_distribution<std::size_t>(0, std::size(numbers) - 1)(random_)]); break;
      case 1: put(counts[std::uniform_int_distribution<std::size_t>(0, std::size(counts) - 1)(random_)]); break;
      default: put(static_cast<std::uint8_t>(random_()));
    }
  }

  description::Experiment experiment_;
  std::mt19937 random_{20};
};

TEST_P(ChangedSnapshot, IsRejectedOrRuns) {
  const std::vector<std::byte> whole = snapshot();
  int refused = 0, changed = 0;
  const char* const more = std::getenv("COHORT_TEST_CHANGES");
  const int changes = more == nullptr ? 3000 : std::atoi(more);
  for (int i = 0; i < changes; ++i) {
    std::vector<std::byte> bytes = whole;
    change(bytes);
    if (bytes == whole) continue;
    ++changed;
    Simulation simulation(experiment_, 1);
    try {
      simulation.restore(bytes);
    } catch (const SnapshotError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("snapshot"), std::string::npos) << error.what();
      continue;
    }
    try {
      for (int tick = 0; tick < 3; ++tick) simulation.step();
      simulation.state_hash();
    } catch (const std::runtime_error&) {  // an event that cannot be done ends a run with its reason
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, changed) << "most numbers may be others";
}

// A world without belts has the same numbers in both layouts: only the mark at the beginning differs.
TEST_P(ChangedSnapshot, OfTheFirstLayoutGivesTheSameBits) {
  std::vector<std::byte> bytes = snapshot();
  Simulation latest(experiment_, 1), first(experiment_, 1);
  latest.restore(bytes);
  constexpr std::uint64_t first_mark = 0x746f6873'74726f68u;
  std::memcpy(bytes.data(), &first_mark, sizeof first_mark);
  first.restore(bytes);
  for (Simulation* simulation : {&latest, &first})
    for (int tick = 0; tick < 10; ++tick) simulation->step();
  EXPECT_EQ(first.state_hash(), latest.state_hash());
}

INSTANTIATE_TEST_SUITE_P(All, ChangedSnapshot,
                         testing::Values(Case{"lifting"}, Case{"wheels"}, Case{"changes"}, Case{"quadcopters"},
                                         Case{"lifting", Fidelity::articulated, Dynamics::cohort},
                                         Case{"obstacle_avoidance", Fidelity::planar}),
                         [](const auto& instance) { return instance.param.name + std::to_string(instance.index); });

}  // namespace
}  // namespace cohort
