// SPDX-License-Identifier: Apache-2.0
#include "server/recording/replay.hpp"

#include <gtest/gtest.h>

namespace cohort::recording {
namespace {

// A recording of a version that kept paths with ".." if the experiment was named by a relative path.
TEST(Replay, ReadsRecordingsWithUnnormalizedPaths) {
  for (const char* const name : {"named_from_its_folder.mcap", "named_through_another_folder.mcap"}) {
    SCOPED_TRACE(name);
    const Recording recording(std::filesystem::path(COHORT_SOURCE_DIR "/tests/data/recordings") / name);
    Replay replay(recording, 1);
    int boundaries = 0;
    while (replay.advance()) ++boundaries;
    EXPECT_GT(boundaries, 4);
    EXPECT_GT(replay.simulation().robot_count(), 0U);
  }
}

// Two robots drive for a second, with a snapshot every half second, in version 0.1.0.
TEST(Replay, StartsAtASnapshotOfVersion010) {
  using namespace std::chrono_literals;
  const Recording recording(COHORT_SOURCE_DIR "/tests/data/recordings/version_0_1_0.mcap");
  EXPECT_EQ(recording.facts().at("version"), "0.1.0");
  ASSERT_EQ(recording.snapshots().size(), 2U);
  Replay replay(recording, 1);
  ASSERT_TRUE(replay.seek(600ms));
  EXPECT_EQ(replay.recorded().log_time, 600ms);
  int boundaries = 0;
  do ++boundaries;
  while (replay.advance());
  EXPECT_EQ(boundaries, 41);
}

}  // namespace
}  // namespace cohort::recording
