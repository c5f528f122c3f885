#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/control.hpp"
#include "tests/support/field_of_robots.hpp"

namespace cohort::test {
namespace {

std::uint64_t tick_of(const nlohmann::json& event) { return event["tick"]; }

// Without a controller a robot that does not require one does nothing; with one it is asked from the tick on that the
// list of events has; when the controller leaves, the robot stands still again, and the run goes on.
TEST(JoinAndLeaveAtTickBoundariesOnly, OfControllersThatARunCanDoWithout) {
  const FieldOfRobots field(4, 12.0, ", required: false",
                            "constant, parameters: {treel/left/velocity: 0.1, "
                            "treel/right/velocity: 0.1}");
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused"}), {{"COHORT_LOG", "info"}});
  control(domain, {"step", "100"});  // it begins with nobody
  Process early(FieldOfRobots::host(domain, "0..1", "constant"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_0")) << server.output();
  control(domain, {"step", "100"});
  Process late(FieldOfRobots::host(domain, "2", "constant"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_2")) << server.output();
  control(domain, {"step", "100"});
  early.signal(SIGTERM);
  ASSERT_TRUE(server.wait_for_output("with swarm/sbot_0 and 1 more is gone")) << server.output();
  control(domain, {"step", "100"});
  Process again(FieldOfRobots::host(domain, "0", "constant"));
  ASSERT_TRUE(comes_to_drive(domain, 0)) << server.output();
  control(domain, {"resume"});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(late.wait_for_exit(), 0) << late.output();
  EXPECT_EQ(again.wait_for_exit(), 0) << again.output();

  const auto summary = field.summary();
  EXPECT_EQ(summary["ticks"], 1200);
  const auto joined = events_of(summary, "joined");
  const auto lost = events_of(summary, "lost");
  ASSERT_EQ(joined.size(), 3u) << summary.dump(1);
  ASSERT_EQ(lost.size(), 1u) << summary.dump(1);
  EXPECT_EQ(tick_of(joined[0]), 100u);
  EXPECT_EQ(tick_of(joined[1]), 200u);
  EXPECT_EQ(tick_of(lost[0]), 300u);
  EXPECT_EQ(tick_of(joined[2]), 400u);
}

// A robot that is free is never waited for: its controller may be stopped for as long as anybody likes.
TEST(JoinAndLeaveAtTickBoundariesOnly, AFreeControllerThatIsStoppedHoldsNobodyUp) {
  const FieldOfRobots field(2, 6.0, ", mode: free, on_late: zero, deadline: 0.2",
                            "constant, parameters: {treel/left/velocity: 0.1, "
                            "treel/right/velocity: 0.1}");
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused", "--speed", "2"}), {{"COHORT_LOG", "info"}});
  Process controller(FieldOfRobots::host(domain, "all", "constant"));
  control(domain, {"step", "10"});
  controller.signal(SIGSTOP);
  control(domain, {"resume"});
  EXPECT_TRUE(server.wait_for_output("missed: swarm/sbot_0")) << server.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  controller.signal(SIGCONT);
  const auto summary = field.summary();
  EXPECT_EQ(summary["ticks"], 600);
  ASSERT_GE(summary["misses"].size(), 2u);
  EXPECT_EQ(summary["misses"][0]["on_late"], "zero");
  EXPECT_GE(summary["misses"][0]["waited_s"].get<double>(), 0.2);
  EXPECT_GT(summary["lateness_us"]["max"].get<double>(), 0.0);
}

}  // namespace
}  // namespace cohort::test
