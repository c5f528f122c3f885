// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/watchdog.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/captured_stderr.hpp"
#include "tests/support/patience.hpp"

namespace cohort::tool {
namespace {

constexpr std::chrono::milliseconds short_patience{1};

TEST(Watchdog, NamesTheTickAndTheStageOfAStepThatTakesTooLong) {
  const test::CapturedStderr errors;
  Log log({.level = LogLevel::error});
  const std::atomic<bool> stop = false;
  Watchdog watchdog(stop, log, short_patience);
  watchdog.reached(7);
  {
    StageMarks stages;
    stages.enter("physics");
    StageMarks inner;
    inner.enter("collision detection");
    EXPECT_TRUE(test::eventually([&] { return errors.contains("tick 7 has not ended"); }));
    EXPECT_TRUE(errors.contains("its stage is now: collision detection")) << errors.text();
  }
  watchdog.reached(8);
  StageMarks stages;
  stages.enter("sensors");
  EXPECT_TRUE(test::eventually([&] { return errors.contains("tick 8 has not ended"); })) << "it warns of each tick";
  EXPECT_TRUE(errors.contains("its stage is now: sensors")) << errors.text();
}

TEST(Watchdog, WatchesTheThreadOfTheRunOnlyWhileItLives) {
  Log log({.level = LogLevel::error});
  const std::atomic<bool> stop = false;
  EXPECT_EQ(TickStage::of_this_thread, nullptr);
  {
    Watchdog watchdog(stop, log);
    watchdog.reached(0);
    EXPECT_NE(TickStage::of_this_thread, nullptr);
  }
  EXPECT_EQ(TickStage::of_this_thread, nullptr);
}

TEST(StageMarks, NameTheInnermostStageAndCountWhatHasBegun) {
  TickStage stage;
  TickStage::of_this_thread = &stage;
  for (std::uint64_t n = 1; n <= 3; ++n) {
    StageMarks marks;
    marks.enter("physics");
    {
      StageMarks inner;
      inner.enter("collision detection");
      EXPECT_STREQ(stage.name(), "collision detection");
    }
    EXPECT_STREQ(stage.name(), "physics");
    EXPECT_EQ(stage.begun(), n);
  }
  EXPECT_EQ(stage.name(), nullptr);
  TickStage::of_this_thread = nullptr;
}

}  // namespace
}  // namespace cohort::tool
