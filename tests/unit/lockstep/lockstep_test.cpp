// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "server/lockstep/barrier.hpp"
#include "server/lockstep/latency_histogram.hpp"
#include "server/lockstep/leases.hpp"
#include "server/lockstep/resend_timer.hpp"

namespace cohort::lockstep {
namespace {

using description::OnLate;
using description::Policy;
using namespace std::chrono_literals;
using Verdict = Barrier::Verdict;
using Kind = Barrier::Outcome::Kind;
using Robots = std::vector<std::uint32_t>;
using Ticks = std::vector<std::uint64_t>;

Policy policy(std::uint32_t period = 1, std::uint32_t phase = 0, std::uint32_t delay = 0, OnLate on_late = OnLate::wait,
              Time deadline = 0ns) {
  return {period, phase, delay, on_late, deadline};
}

Barrier barrier_of(const std::vector<Policy>& policies) {
  Barrier barrier;
  for (const Policy& policy : policies) barrier.add(policy, 1, 0);
  return barrier;
}

void answer(Barrier& barrier, std::uint32_t robot, std::uint64_t frame, double value) {
  ASSERT_EQ(barrier.judge(robot, frame), Verdict::accepted);
  barrier.answer(robot, frame, std::vector<double>{value});
}

TEST(Barrier, WaitsUntilEveryRobotHasAnswered) {
  Barrier barrier = barrier_of({policy(), policy()});
  barrier.open(0, 0ns);
  EXPECT_EQ(barrier.awaited(), (Robots{0, 1}));
  answer(barrier, 1, 0, 7.0);
  EXPECT_FALSE(barrier.complete());
  EXPECT_EQ(barrier.awaited(), Robots{0});
  answer(barrier, 0, 0, 3.0);
  EXPECT_TRUE(barrier.complete());
  EXPECT_EQ(barrier.outcome(0).kind, Kind::command);
  EXPECT_EQ(barrier.outcome(0).values[0], 3.0);
  EXPECT_EQ(barrier.outcome(1).values[0], 7.0);
}

TEST(Barrier, NeverGivesUpUnderWait) {
  Barrier barrier = barrier_of({policy()});
  barrier.open(0, 0ns);
  EXPECT_FALSE(barrier.next_deadline());
  EXPECT_TRUE(barrier.expire(std::chrono::hours(1000)).empty());
  EXPECT_FALSE(barrier.complete());
}

TEST(Barrier, AsksEveryPeriodFromThePhaseAndKeepsTheLastCommandBetween) {
  Barrier barrier = barrier_of({policy(3, 1)});
  Ticks due;
  for (std::uint64_t tick = 0; tick < 8; ++tick) {
    barrier.open(tick, 0ns);
    if (barrier.is_due(0, tick)) {
      due.push_back(tick);
      answer(barrier, 0, tick, static_cast<double>(tick));
      EXPECT_EQ(barrier.outcome(0).kind, Kind::command);
    } else {
      EXPECT_TRUE(barrier.complete()) << tick;
      EXPECT_EQ(barrier.outcome(0).kind, Kind::keep) << tick;
    }
  }
  EXPECT_EQ(due, (Ticks{1, 4, 7}));
}

TEST(Barrier, AsksNobodyWhoIsNotInTheWorld) {
  Barrier barrier = barrier_of({policy(), policy(1, 0, 1)});
  barrier.set_present(1, false);
  barrier.open(0, 0ns);
  EXPECT_FALSE(barrier.is_due(1, 0));
  answer(barrier, 0, 0, 1.0);
  EXPECT_TRUE(barrier.complete());
  barrier.set_present(1, true);
  barrier.open(1, 0ns);
  EXPECT_TRUE(barrier.is_due(1, 1));
  EXPECT_FALSE(barrier.is_due(1, 0)) << "that frame did not go out";
  answer(barrier, 0, 1, 1.0);
  EXPECT_TRUE(barrier.complete()) << "its first answer acts at tick 2";
  // It goes again: the frame under way is still to be answered, and the one after it never goes out.
  barrier.set_present(1, false);
  barrier.open(2, 0ns);
  EXPECT_FALSE(barrier.is_due(1, 2));
  EXPECT_TRUE(barrier.is_due(1, 1));
  EXPECT_TRUE(barrier.is_awaited(1));
  answer(barrier, 1, 1, 5.0);
  EXPECT_EQ(barrier.awaited(), Robots{0});
  answer(barrier, 0, 2, 1.0);
  barrier.open(3, 0ns);
  EXPECT_EQ(barrier.awaited(), Robots{0});
}

TEST(Barrier, LetsAnAnswerActAtExactlyItsDelay) {
  Barrier barrier = barrier_of({policy(1, 0, 2)});
  for (std::uint64_t tick = 0; tick < 2; ++tick) {
    barrier.open(tick, 0ns);
    EXPECT_TRUE(barrier.complete()) << "nothing can act yet at tick " << tick;
    EXPECT_EQ(barrier.outcome(0).kind, Kind::keep);
  }
  barrier.open(2, 0ns);
  EXPECT_EQ(barrier.unanswered(0), (Ticks{0, 1, 2}));
  answer(barrier, 0, 1, 11.0);  // answers may overtake each other
  answer(barrier, 0, 2, 12.0);
  EXPECT_FALSE(barrier.complete());
  answer(barrier, 0, 0, 10.0);
  EXPECT_TRUE(barrier.complete());
  EXPECT_EQ(barrier.outcome(0).values[0], 10.0);
  barrier.open(3, 0ns);
  EXPECT_TRUE(barrier.complete());
  EXPECT_EQ(barrier.outcome(0).values[0], 11.0);
  barrier.open(4, 0ns);
  EXPECT_EQ(barrier.outcome(0).values[0], 12.0);
}

TEST(Barrier, RejectsRepeatedStaleAndEarlyAnswers) {
  Barrier barrier = barrier_of({policy(2)});
  barrier.open(0, 0ns);
  answer(barrier, 0, 0, 1.0);
  EXPECT_EQ(barrier.judge(0, 0), Verdict::repeated);
  EXPECT_EQ(barrier.judge(0, 2), Verdict::early);
  barrier.open(1, 0ns);
  EXPECT_EQ(barrier.judge(0, 1), Verdict::early) << "it was not asked at tick 1";
  barrier.open(2, 0ns);
  EXPECT_EQ(barrier.judge(0, 0), Verdict::stale);
  EXPECT_EQ(barrier.judge(0, 2), Verdict::accepted);
}

std::string name_of(OnLate on_late) {
  constexpr const char* names[] = {"wait", "hold", "zero", "detach", "stop"};
  return names[static_cast<int>(on_late)];
}

class MissedDeadline : public ::testing::TestWithParam<std::pair<OnLate, Kind>> {};

TEST_P(MissedDeadline, HasTheConsequenceOfItsPolicy) {
  const auto [on_late, kind] = GetParam();
  Barrier barrier = barrier_of({policy(1, 0, 0, on_late, 20ms), policy()});
  barrier.open(0, 100ms);
  EXPECT_EQ(barrier.next_deadline(), Time(120ms));
  EXPECT_TRUE(barrier.expire(119ms).empty());
  const auto misses = barrier.expire(121ms);
  ASSERT_EQ(misses.size(), 1u);
  EXPECT_EQ(misses[0].robot, 0u);
  EXPECT_EQ(misses[0].frame_tick, 0u);
  EXPECT_EQ(misses[0].consequence, on_late);
  EXPECT_EQ(misses[0].waited, Time(21ms));
  EXPECT_EQ(barrier.awaited(), Robots{1}) << "the other robot's policy is its own";
  EXPECT_EQ(barrier.outcome(0).kind, kind);
  EXPECT_EQ(barrier.judge(0, 0), Verdict::stale) << "the world went on without it";
  answer(barrier, 1, 0, 1.0);
  barrier.open(1, 200ms);
  EXPECT_EQ(barrier.is_awaited(0), on_late != OnLate::detach);
}

INSTANTIATE_TEST_SUITE_P(All, MissedDeadline,
                         ::testing::Values(std::pair{OnLate::hold, Kind::keep}, std::pair{OnLate::zero, Kind::neutral},
                                           std::pair{OnLate::detach, Kind::neutral},
                                           std::pair{OnLate::stop, Kind::neutral}),
                         [](const auto& tested) { return name_of(tested.param.first); });

Policy free_policy(OnLate on_late = OnLate::hold, Time silence = 0ns) {
  Policy free = policy(1, 0, 0, on_late, silence);
  free.mode = description::Mode::free;
  return free;
}

TEST(Barrier, NeverWaitsForAFreeRobotWhoseNewestAnswerActs) {
  Barrier barrier = barrier_of({free_policy()});
  barrier.open(0, 0ns);
  EXPECT_TRUE(barrier.complete());
  EXPECT_TRUE(barrier.is_due(0, 0));
  EXPECT_EQ(barrier.outcome(0).kind, Kind::keep);
  for (std::uint64_t tick = 1; tick < 5; ++tick) barrier.open(tick, 0ns);
  answer(barrier, 0, 3, 3.0);
  EXPECT_EQ(barrier.outcome(0).values[0], 3.0);
  EXPECT_EQ(barrier.judge(0, 2), Verdict::stale);
  EXPECT_EQ(barrier.judge(0, 3), Verdict::repeated);
  EXPECT_EQ(barrier.judge(0, 5), Verdict::early);
  barrier.open(5, 0ns);
  EXPECT_EQ(barrier.outcome(0).values[0], 3.0) << "it holds";
  answer(barrier, 0, 5, 5.0);
  EXPECT_EQ(barrier.outcome(0).values[0], 5.0);
}

TEST(Barrier, AFreeRobotMissesOncePerSilence) {
  Barrier barrier = barrier_of({free_policy(OnLate::zero, 1s)});
  barrier.open(0, 10s);
  EXPECT_TRUE(barrier.expire(10900ms).empty());
  barrier.answer(0, 0, std::vector<double>{1.0}, 10950ms);
  EXPECT_TRUE(barrier.expire(11900ms).empty());
  EXPECT_EQ(barrier.outcome(0).kind, Kind::command);
  ASSERT_EQ(barrier.expire(12s).size(), 1u);
  EXPECT_EQ(barrier.outcome(0).kind, Kind::neutral);
  EXPECT_TRUE(barrier.expire(13s).empty());
  barrier.open(1, 13s);
  barrier.answer(0, 1, std::vector<double>{2.0}, 13s);
  EXPECT_EQ(barrier.outcome(0).values[0], 2.0);
  const auto misses = barrier.expire(15s);
  ASSERT_EQ(misses.size(), 1u);
  EXPECT_EQ(misses[0].waited, Time(2s));
}

TEST(Barrier, AsksARobotWithoutADriverNothing) {
  Barrier barrier = barrier_of({policy(), policy(1, 0, 1)});
  barrier.set_driven(0, false);
  barrier.set_driven(1, false);
  barrier.open(0, 0ns);
  EXPECT_TRUE(barrier.complete());
  EXPECT_FALSE(barrier.is_due(0, 0));
  EXPECT_EQ(barrier.outcome(0).kind, Kind::neutral);
  barrier.set_driven(0, true);
  barrier.set_driven(1, true);
  EXPECT_TRUE(barrier.complete()) << "not before the next boundary";
  barrier.open(1, 0ns);
  EXPECT_EQ(barrier.awaited(), Robots{0}) << "the other one's first answer acts a tick later";
  answer(barrier, 0, 1, 1.0);
  answer(barrier, 1, 1, 7.0);
  EXPECT_EQ(barrier.outcome(1).kind, Kind::keep);
  barrier.open(2, 0ns);
  EXPECT_EQ(barrier.awaited(), Robots{0});
  EXPECT_EQ(barrier.outcome(1).values[0], 7.0);
  barrier.set_driven(0, false);
  EXPECT_TRUE(barrier.complete()) << "the driver is lost in mid-tick";
  EXPECT_EQ(barrier.outcome(0).kind, Kind::neutral);
}

TEST(Barrier, CountsAnAnswerThatCannotActAsAMissAtOnce) {
  Barrier barrier = barrier_of({policy(1, 0, 0, OnLate::zero, 1s)});
  barrier.open(0, 0ns);
  barrier.refuse(0, 0);
  EXPECT_TRUE(barrier.complete());
  EXPECT_EQ(barrier.outcome(0).kind, Kind::neutral);
  EXPECT_EQ(barrier.judge(0, 0), Verdict::repeated);
  const auto misses = barrier.take_refused();
  ASSERT_EQ(misses.size(), 1u);
  EXPECT_TRUE(misses[0].refused);
  EXPECT_EQ(misses[0].consequence, OnLate::zero);
  EXPECT_TRUE(barrier.take_refused().empty()) << "each is told once";
}

TEST(Barrier, AFreeRobotWhoseAnswersCannotActMissesOncePerSilence) {
  description::Policy free = policy(1, 0, 0, OnLate::hold, 1s);
  free.mode = description::Mode::free;
  Barrier barrier = barrier_of({free});
  barrier.open(0, 0ns);
  for (int i = 0; i < 100; ++i) barrier.refuse(0, 0);
  EXPECT_EQ(barrier.take_refused().size(), 1u);
  answer(barrier, 0, 0, 1.0);
  barrier.open(1, 0ns);
  barrier.refuse(0, 1);
  EXPECT_EQ(barrier.take_refused().size(), 1u);
}

Leases::Decisions decide(Leases& leases, Time now = 10s) {
  return leases.decide(now, [](const Robots&) { return true; });
}

TEST(Leases, GrantsFreeRobots) {
  Leases leases(4);
  leases.claim(100, {0, 1});
  const auto decisions = decide(leases);
  ASSERT_EQ(decisions.granted.size(), 1u);
  EXPECT_EQ(leases.holder(0), 100u);
  EXPECT_EQ(leases.lease(100)->robots, (Robots{0, 1}));
  EXPECT_FALSE(leases.holder(2));
}

TEST(Leases, GrantsNothingUntilItMay) {
  Leases leases(1);
  leases.claim(100, {0});
  EXPECT_TRUE(leases.decide(10s, [](const Robots&) { return false; }).granted.empty());
  EXPECT_TRUE(leases.has_claims());
  EXPECT_EQ(decide(leases).granted.size(), 1u);
}

TEST(Leases, RefusesARobotWhoseHolderShowsThatItLives) {
  Leases leases(2);
  leases.claim(100, {0, 1});
  decide(leases);
  leases.note_answer(100);
  leases.claim(200, {1});
  EXPECT_TRUE(decide(leases).refused.empty()) << "an answer from before the claim proves nothing";
  leases.note_answer(100);
  const auto decisions = decide(leases);
  ASSERT_EQ(decisions.refused.size(), 1u);
  EXPECT_EQ(decisions.refused[0].client, 200u);
  EXPECT_EQ(decisions.refused[0].robot, 1u);
  EXPECT_EQ(decisions.refused[0].holder, 100u);
  EXPECT_EQ(leases.holder(1), 100u);
}

TEST(Leases, HandsTheRobotsOfADeadHolderOverWithANewEpoch) {
  Leases leases(3);
  leases.claim(100, {0, 1});
  decide(leases);
  const std::uint64_t epoch = leases.lease(100)->epoch;
  leases.claim(200, {1, 2});
  EXPECT_TRUE(decide(leases).granted.empty());
  leases.set_alive(100, false);
  const auto decisions = decide(leases);
  ASSERT_EQ(decisions.granted.size(), 1u);
  EXPECT_EQ(decisions.granted[0].superseded, std::vector<std::uint64_t>{100});
  EXPECT_GT(leases.lease(200)->epoch, epoch);
  EXPECT_EQ(leases.lease(100), nullptr);
  EXPECT_FALSE(leases.holder(0)) << "losing one robot ends the whole lease";
}

// It was stopped, went on, answered once, and was killed before liveliness had noticed that it went on.
TEST(Leases, AnAnswerIsNoSignOfLifeForEver) {
  Leases leases(1);
  leases.claim(100, {0});
  decide(leases);
  leases.set_alive(100, false);
  leases.note_answer(100, 10s);
  leases.claim(200, {0});
  EXPECT_TRUE(decide(leases, 10900ms).granted.empty());
  EXPECT_EQ(decide(leases, 11s).granted.size(), 1u);
}

TEST(Leases, TakesAnAnswerAsASignOfLifeThoughLivelinessSaidOtherwise) {
  Leases leases(1);
  leases.claim(100, {0});
  decide(leases);
  leases.set_alive(100, false);
  leases.claim(200, {0});
  leases.note_answer(100, 10s);
  const auto decisions = decide(leases, 10s);
  EXPECT_TRUE(decisions.granted.empty());
  ASSERT_EQ(decisions.refused.size(), 1u);
  EXPECT_EQ(decisions.refused[0].client, 200u);
}

TEST(Leases, ChangeToOtherRobotsUnderANewEpoch) {
  Leases leases(4);
  leases.claim(1, {0, 1});
  leases.decide(Time{0}, [](const auto&) { return true; });
  const std::uint64_t before = leases.lease(1)->epoch;
  leases.note_answer(1);
  leases.change(1, {0, 3});
  EXPECT_GT(leases.lease(1)->epoch, before);
  EXPECT_EQ(leases.lease(1)->robots, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(leases.lease(1)->answer_count, 1u);
  EXPECT_EQ(leases.holder(3), 1u);
  EXPECT_FALSE(leases.holder(1));
}

TEST(Leases, KeepsTheEpochOfAClientThatAsksForItsOwnRobotsAgain) {
  Leases leases(2);
  leases.claim(100, {0, 1});
  decide(leases);
  const std::uint64_t epoch = leases.lease(100)->epoch;
  leases.claim(100, {0, 1});
  const auto decisions = decide(leases);
  ASSERT_EQ(decisions.granted.size(), 1u);
  EXPECT_TRUE(decisions.granted[0].again);
  EXPECT_EQ(leases.lease(100)->epoch, epoch);
}

TEST(ResendTimer, WaitsTwoMillisecondsAtFirstAndThenLongerAndLonger) {
  ResendTimer timer;
  timer.start(0, 1s);
  EXPECT_EQ(timer.due(), Time(1002ms));
  EXPECT_FALSE(timer.is_due(1001ms));
  EXPECT_TRUE(timer.is_due(1002ms));
  timer.resent(1002ms);
  EXPECT_EQ(timer.due(), Time(1004250us));
  for (int i = 0; i < 50; ++i) timer.resent(2s);
  EXPECT_EQ(timer.due(), Time(2500ms));
}

TEST(ResendTimer, WaitsThreeRoundTripsOfASlowClient) {
  ResendTimer timer;
  Time now = 1s;
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    if (tick > 0) timer.note_answer(tick - 1, 0, now - 30ms);
    timer.start(tick, now);
    now += 50ms;
  }
  now -= 50ms;
  EXPECT_FALSE(timer.is_due(now + 59ms));
  EXPECT_TRUE(timer.is_due(now + 60ms));
}

TEST(ResendTimer, WhatWasLostIsNotTheClientsSlowness) {
  ResendTimer timer;
  Time now = 1s;
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    timer.start(tick, now);
    ASSERT_TRUE(timer.is_due(now + 40ms));
    timer.resent(now + 40ms);  // this is the one that comes
    timer.note_answer(tick, 1, now + 41ms);
    now += 50ms;
  }
  timer.start(5, now);
  EXPECT_TRUE(timer.is_due(now + 3ms));
}

TEST(RoundTrips, AMedian) {
  RoundTrips round_trips;
  EXPECT_EQ(round_trips.median(), 0ns);
  for (const auto value : {5ms, 1ms, 3ms}) round_trips.add(value);
  EXPECT_EQ(round_trips.median(), Time(3ms));
  for (int i = 0; i < 31; ++i) round_trips.add(9ms);
  EXPECT_EQ(round_trips.median(), Time(9ms));
}

TEST(LatencyHistogram, GivesQuantilesToWithinThreePercent) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0ns);
  for (int i = 1; i <= 1000; ++i) histogram.add(std::chrono::microseconds(i));
  EXPECT_NEAR(static_cast<double>(histogram.quantile(0.5).count()), 500e3, 16e3);
  EXPECT_NEAR(static_cast<double>(histogram.quantile(0.99).count()), 990e3, 32e3);
  EXPECT_EQ(histogram.quantile(1.0), 1000us);
  EXPECT_EQ(histogram.max(), 1000us);
}

}  // namespace
}  // namespace cohort::lockstep
