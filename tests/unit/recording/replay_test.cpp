#include "server/recording/replay.hpp"

#include <gtest/gtest.h>

namespace cohort::recording {
namespace {

// Of a version whose kept paths had ".." in them where the experiment was named by a relative path. Numbers may differ
// from version to version, so only that the world is built and runs is held.
TEST(Replay, ReadsRecordingsWhoseKeptPathsAreNotNormal) {
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

}  // namespace
}  // namespace cohort::recording
