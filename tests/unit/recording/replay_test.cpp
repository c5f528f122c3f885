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

}  // namespace
}  // namespace cohort::recording
