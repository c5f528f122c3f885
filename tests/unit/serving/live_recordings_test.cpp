// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/live_recordings.hpp"

#include <gtest/gtest.h>

#include "tests/support/patience.hpp"
#include "tests/support/robots.hpp"

namespace cohort::session {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(LiveRecordingsOfARun, ReportTheirMemoryAndWhyTheyWereDropped) {
  description::Experiment experiment;
  experiment.name = "recorded";
  experiment.world = world_with_floor();
  experiment.duration = 10s;
  place(experiment.world, tracked_robot(), "robot", at(0.0, 0.0, 0.0));
  experiment.teams.push_back({"team", {0}, "none", {}});
  Simulation simulation(experiment, 1);
  LiveRecordings recordings;
  recordings.begin(experiment, simulation, false);
  for (const std::uint64_t client : {1, 2}) recordings.start(client, "");
  recordings.stop(1);
  recordings.stop(2);
  const auto kept_of = [&](std::uint64_t client) {
    std::vector<KeptForClient> kept;
    recordings.list(kept);
    const auto found = std::ranges::find(kept, client, &KeptForClient::client);
    return found == kept.end() ? 0 : found->bytes;
  };
  EXPECT_TRUE(eventually([&] { return kept_of(1) > 100 && kept_of(2) > 100; }));
  recordings.drop(1, "too much");
  EXPECT_EQ(kept_of(1), 0u);
  EXPECT_GT(kept_of(2), 0u);
  try {
    recordings.fetch(1, 0);
    ADD_FAILURE() << "it is there";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "too much");
  }
  recordings.start(1, "");
  EXPECT_NO_THROW(recordings.fetch(1, 0)) << "another one";
  recordings.drop(1, "too much");
  recordings.leave(1);
  EXPECT_FALSE(recordings.fetch(1, 0)) << "its client has disconnected, and may be another";
  recordings.end(RunResult::End::finished, "");
}

}  // namespace
}  // namespace cohort::session
