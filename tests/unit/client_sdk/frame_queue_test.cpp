// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/frame_queue.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace cohort {
namespace {

constexpr std::uint64_t client = 9;

wire::Admit lease(std::uint32_t run, std::uint64_t epoch, std::uint64_t tick, std::vector<wire::AdmittedRobot> robots) {
  return {.client = client, .run = run, .epoch = epoch, .tick = tick, .robots = std::move(robots)};
}

class FrameQueueTest : public testing::Test {
 protected:
  void arrive(std::uint64_t tick, std::uint64_t epoch = 1, std::uint32_t run = 0) {
    const std::vector<std::uint32_t> robots{3};
    const std::vector<double> values{static_cast<double>(tick)};
    queue.arrive({.client = client, .run = run, .epoch = epoch, .tick = tick, .robots = robots, .values = values});
  }
  // Answers what can be answered now, with ten times the tick, and returns the ticks.
  std::vector<std::uint64_t> answer_all() {
    std::vector<std::uint64_t> ticks;
    while (const wire::Observation* frame = queue.next()) {
      EXPECT_EQ(frame->values[0], static_cast<double>(frame->tick));
      const std::vector<double> answer{10.0 * frame->values[0]};
      const wire::Command command = queue.finish(answer);
      EXPECT_EQ(command.client, client);
      EXPECT_EQ(command.robots.size(), 1u);
      EXPECT_EQ(command.values[0], 10.0 * static_cast<double>(command.tick));
      ticks.push_back(command.tick);
    }
    return ticks;
  }
  std::optional<std::uint64_t> repeat() {
    const auto command = queue.next_repeat();
    if (!command) return std::nullopt;
    EXPECT_EQ(command->values[0], 10.0 * static_cast<double>(command->tick));
    return command->tick;
  }
  using Ticks = std::vector<std::uint64_t>;

  FrameQueue queue;
};

TEST_F(FrameQueueTest, FramesThatArriveBeforeTheirLeaseWaitForIt) {
  arrive(0);
  EXPECT_EQ(queue.next(), nullptr);
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  EXPECT_EQ(answer_all(), Ticks{0});
}

TEST_F(FrameQueueTest, ARepeatedFrameIsAnsweredOnceAndThenFromMemory) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  arrive(0);
  arrive(0);
  EXPECT_EQ(answer_all(), Ticks{0});
  EXPECT_EQ(repeat(), std::nullopt);
  arrive(0);
  arrive(0);
  EXPECT_EQ(repeat(), 0u);
  EXPECT_EQ(repeat(), std::nullopt);
}

TEST_F(FrameQueueTest, AFrameRepeatedWhileItIsBeingAnsweredIsIgnored) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  arrive(0);
  ASSERT_NE(queue.next(), nullptr);
  arrive(0);
  queue.finish(std::vector<double>{0.0});
  EXPECT_EQ(queue.next(), nullptr);
  EXPECT_EQ(repeat(), std::nullopt);
}

TEST_F(FrameQueueTest, TheLastEightAnswersAreKept) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    arrive(tick);
    EXPECT_EQ(answer_all(), Ticks{tick});
  }
  arrive(11);
  EXPECT_EQ(repeat(), std::nullopt);
  arrive(12);
  EXPECT_EQ(repeat(), 12u);
}

TEST_F(FrameQueueTest, AnAnswerIsKeptForEachFrameThatCanBeOut) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .delay = 12}}));
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    arrive(tick);
    EXPECT_EQ(answer_all(), Ticks{tick});
  }
  arrive(7);
  EXPECT_EQ(repeat(), 7u);
}

TEST_F(FrameQueueTest, FramesOfAnEarlierEpochAreDropped) {
  queue.begin(lease(1, 5, 0, {{.robot = 3}}));
  arrive(0, 4, 1);
  arrive(0, 4, 2);
  EXPECT_EQ(answer_all(), Ticks{});
  arrive(0, 5, 1);
  EXPECT_EQ(answer_all(), Ticks{0});
}

// The runs of the new server begin at 1 again.
TEST_F(FrameQueueTest, TheFramesOfAReplacementServerAreNewer) {
  queue.begin(lease(7, 5, 0, {{.robot = 3}}));
  arrive(0, 9, 1);
  queue.begin(lease(1, 9, 0, {{.robot = 3}}));
  EXPECT_EQ(answer_all(), Ticks{0});
}

TEST_F(FrameQueueTest, ANewLeaseDiscardsTheAnswersAndKeepsItsFrames) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  arrive(0);
  answer_all();
  arrive(1);
  arrive(0, 2, 1);
  queue.begin(lease(1, 2, 0, {{.robot = 3}}));
  EXPECT_EQ(answer_all(), Ticks{0});
  arrive(0, 1, 0);
  EXPECT_EQ(repeat(), std::nullopt);
}

TEST_F(FrameQueueTest, FramesBeforeTheFirstOfTheLeaseAreDropped) {
  arrive(4);
  queue.begin(lease(0, 1, 5, {{.robot = 3}}));
  arrive(3);
  arrive(5);
  EXPECT_EQ(answer_all(), Ticks{5});
}

TEST_F(FrameQueueTest, WithADelayALostFrameIsAwaitedBeforeTheNextIsAnswered) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .delay = 2}}));
  arrive(1);
  arrive(2);
  EXPECT_EQ(answer_all(), Ticks{}) << "the server still wants the answer to 0 and will send it again";
  arrive(0);
  EXPECT_EQ(answer_all(), (Ticks{0, 1, 2}));
}

TEST_F(FrameQueueTest, AFrameThatTheServerHasGivenUpIsNotAwaited) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .delay = 2}}));
  arrive(1);
  arrive(2);
  arrive(3);
  EXPECT_EQ(answer_all(), (Ticks{1, 2, 3})) << "3 is out, so the server needs no answer to 0 any more";
}

TEST_F(FrameQueueTest, AFrameRepeatedWithoutItsPredecessorIsFinallyAnswered) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .delay = 2}}));
  arrive(1);
  for (int i = 0; i < 7; ++i) arrive(1);
  EXPECT_EQ(answer_all(), Ticks{});
  arrive(1);
  EXPECT_EQ(answer_all(), Ticks{1});
}

TEST_F(FrameQueueTest, WithoutADelayNothingIsAwaited) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  arrive(7);
  arrive(4);
  EXPECT_EQ(answer_all(), (Ticks{4, 7}));
}

TEST_F(FrameQueueTest, TicksAtWhichNoRobotIsDueAreNotAwaited) {
  queue.begin(
      lease(0, 1, 0, {{.robot = 3, .period = 4, .phase = 1, .delay = 8}, {.robot = 5, .period = 6, .delay = 8}}));
  arrive(0);
  arrive(1);
  arrive(5);
  arrive(9);
  EXPECT_EQ(answer_all(), (Ticks{0, 1, 5})) << "due: 0, 1, 5, 6, 9";
  arrive(6);
  EXPECT_EQ(answer_all(), (Ticks{6, 9}));
}

TEST_F(FrameQueueTest, OnlyTheNewestFrameOfAFreeRobotIsAnswered) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .mode = wire::Mode::free}}));
  arrive(2);
  arrive(5);
  arrive(4);
  EXPECT_EQ(answer_all(), Ticks{5});
  arrive(9);
  EXPECT_EQ(answer_all(), Ticks{9});
}

TEST_F(FrameQueueTest, AnAnswerNamesTheCopyOfItsFrame) {
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  const std::vector<std::uint32_t> robots{3};
  const std::vector<double> values{0.0};
  const auto arrive_as_copy = [&](std::uint32_t copy) {
    queue.arrive({.client = client, .resent = copy, .epoch = 1, .robots = robots, .values = values});
  };
  arrive_as_copy(2);
  arrive_as_copy(3);
  ASSERT_NE(queue.next(), nullptr);
  EXPECT_EQ(queue.finish(values).resent, 2u) << "the first that came";
  arrive_as_copy(4);
  EXPECT_EQ(queue.next_repeat()->resent, 4u);
}

TEST_F(FrameQueueTest, AFloodOfFramesIsBounded) {
  for (std::uint64_t tick = 0; tick < 1000; ++tick) arrive(tick);
  queue.begin(lease(0, 1, 0, {{.robot = 3}}));
  EXPECT_EQ(answer_all().size(), 64u);
}

TEST_F(FrameQueueTest, ALeaseWithMoreRobotsKeepsItsAnswers) {
  queue.begin(lease(0, 1, 0, {{.robot = 3, .delay = 2}}));
  for (std::uint64_t tick = 0; tick < 10; ++tick) arrive(tick);
  EXPECT_EQ(answer_all().size(), 10u);
  arrive(10);
  queue.extend(lease(0, 2, 8, {{.robot = 3, .delay = 2}, {.robot = 4, .delay = 20}}));
  arrive(9, 2);
  EXPECT_EQ(repeat(), 9u) << "not computed again";
  EXPECT_EQ(answer_all(), Ticks{}) << "the frame of the former epoch is sent again under the new one";
  for (std::uint64_t tick = 10; tick < 20; ++tick) arrive(tick, 2);
  EXPECT_EQ(answer_all().size(), 10u);
  for (const std::uint64_t tick : {4, 9, 10, 19}) {
    arrive(tick, 2);
    EXPECT_EQ(repeat(), tick);
  }
}

}  // namespace
}  // namespace cohort
