// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <poll.h>

#include <cohort/observer.hpp>

#include "tests/support/controlled_run.hpp"

// The functions of <cohort/observer.hpp>.
namespace cohort::test {
namespace {

using std::chrono::milliseconds;

bool is_readable(const Observer& observer, milliseconds at_most = milliseconds(0)) {
  pollfd asked{observer.descriptor(), POLLIN, 0};
  return ::poll(&asked, 1, static_cast<int>(at_most.count())) == 1;
}

// Steps until the observer receives a tick: the first ticks may precede the discovery.
std::optional<WorldState> step_until_seen(Control& control, Observer& observer) {
  std::optional<WorldState> seen;
  eventually([&] {
    control.step();
    return (seen = observer.next(milliseconds(100))).has_value();
  });
  return seen;
}

TEST(ProgramsObserveARun, TheySeeEachTickAsItIsPublished) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Observer observer({.domain = run.domain().number()});
  EXPECT_FALSE(observer.latest());
  EXPECT_FALSE(observer.next(milliseconds(0)));
  EXPECT_FALSE(is_readable(observer));
  Control control = control_of(run);
  ASSERT_TRUE(step_until_seen(control, observer));
  while (observer.next(milliseconds(200))) {
  }
  const std::uint64_t before = control.step(3).tick - 3;
  for (std::uint64_t tick = before + 1; tick <= before + 3; ++tick) {
    ASSERT_TRUE(is_readable(observer, patience));
    auto state = observer.next(patience);
    while (state && state->tick < tick) state = observer.next(patience);  // the tick that it was paused at comes again
    ASSERT_TRUE(state);
    EXPECT_EQ(state->tick, tick);
    EXPECT_EQ(state->run, 1u);
    EXPECT_EQ(state->time, milliseconds(10) * tick);
  }
  EXPECT_FALSE(is_readable(observer));
  const auto latest = observer.latest();
  ASSERT_TRUE(latest);
  EXPECT_EQ(latest->tick, before + 3);
  EXPECT_EQ(latest->state_hash, control.status().state_hash);
  ASSERT_EQ(latest->robots.size(), 2u);
  EXPECT_EQ(latest->robots[1].robot, 1u);
  EXPECT_EQ(latest->robots[1].pose, control.entity_state("swarm/sbot_1").pose);

  control.step(Observer::most_waiting + 10);
  EXPECT_TRUE(eventually([&] { return observer.latest()->tick == before + 13 + Observer::most_waiting; }));
  EXPECT_EQ(observer.next(patience)->tick, before + 14) << "the oldest unread ones are dropped";
  control.quit();
  run.finish();
}

TEST(ProgramsObserveARun, TheyKnowAllRobotsByNameIncludingLaterOnes) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Observer observer({.domain = run.domain().number()});
  const auto robots = observer.robots(patience);
  ASSERT_TRUE(robots);
  ASSERT_EQ(robots->size(), 2u);
  EXPECT_EQ(robots->at(1).robot, 1u);
  EXPECT_EQ(robots->at(1).name, "swarm/sbot_1");
  EXPECT_EQ(robots->at(1).model, "sbot");
  EXPECT_EQ(robots->at(1).team, "swarm");
  Control control = control_of(run);
  control.spawn({.name = "late", .model = "sbot", .pose = {{0.4, 0.1, 0}, {}}});
  const auto more = observer.robots(patience);
  ASSERT_TRUE(more);
  ASSERT_EQ(more->size(), 3u);
  EXPECT_EQ(more->at(2).name, "late");
  EXPECT_FALSE(observer.robots(milliseconds(0)));
  control.quit();
  run.finish();
}

TEST(ProgramsObserveARun, TheyReceiveEachEventOnce) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Observer observer({.domain = run.domain().number()});
  Control control = control_of(run);
  control.step(2);
  const auto first = observer.events(patience);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->events.empty());
  EXPECT_TRUE(observer.events(patience)->events.empty());
  control.set_speed(2.0);
  const auto second = observer.events(patience);
  ASSERT_EQ(second->events.size(), 1u);
  EXPECT_EQ(second->events[0].kind, "control");
  EXPECT_EQ(second->events[0].tick, 2u);
  control.reset();
  control.set_speed(3.0);
  const auto third = observer.events(patience);
  EXPECT_EQ(third->run, 2u);
  EXPECT_TRUE(std::ranges::any_of(third->events, [](const RunEvent& event) { return event.kind == "control"; }));
  control.quit();
  run.finish();
}

TEST(ProgramsObserveARun, TheyReceiveItsResult) {
  const FieldOfRobots field(2, 0.5);
  ControlledRun run(field, {"--paused"});
  Observer observer({.domain = run.domain().number()});
  Control control = control_of(run);
  ASSERT_TRUE(step_until_seen(control, observer));
  EXPECT_FALSE(observer.ended());
  control.play();
  run.finish();
  while (observer.next(patience)) {
  }
  EXPECT_EQ(observer.latest()->tick, 50u);
  const auto ended = observer.ended();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->end, ObserverEnd::run_ended);
  EXPECT_EQ(ended->how, "finished");
  EXPECT_TRUE(is_readable(observer));
}

TEST(ProgramsObserveARun, TheyNoticeADeadServerAndContinueWithAnother) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Observer observer({.domain = run.domain().number()});
  Control control = control_of(run);
  ASSERT_TRUE(step_until_seen(control, observer));
  run.server().signal(SIGKILL);
  while (observer.next(patience)) {
  }
  const auto ended = observer.ended();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->end, ObserverEnd::server_gone);
  Process another(field.serve(run.domain(), {"--paused"}));
  run.attach();
  Control again({.domain = run.domain().number(), .time_limit = patience});
  ASSERT_TRUE(step_until_seen(again, observer));
  EXPECT_FALSE(observer.ended());
  again.quit();
  another.wait_for_exit();
}

}  // namespace
}  // namespace cohort::test
