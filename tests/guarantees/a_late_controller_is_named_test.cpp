// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "idl/dds/transport.hpp"
#include "tests/support/control.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// An observer of a run, so that a test can act during it.
class SeenTicks {
 public:
  explicit SeenTicks(std::uint32_t domain)
      : participant_(wire::Participant::client(domain)),
        reader_(participant_, {[this](const wire::WorldState& state, const wire::Sender&) { tick_ = state.tick; }, {}},
                "view") {}

  bool wait_for_tick(std::uint64_t tick) {
    return eventually([&] { return tick_ >= tick; });
  }
  std::uint64_t tick() const { return tick_; }

 private:
  std::atomic<std::uint64_t> tick_ = 0;
  wire::Participant participant_;
  wire::Reader<wire::WorldState> reader_;
};

class DisturbedRun : public ::testing::Test {
 protected:
  std::unique_ptr<Process> start_controllers(const std::string& robots) {
    return std::make_unique<Process>(std::vector<std::string>{cohort_program(), "host", "obstacle_avoidance",
                                                              "--robots", robots, "--domain", domain.text()});
  }
  void expect_undisturbed_end() {
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_NE(server.output().find(reference_hash(10)), std::string::npos) << server.output();
  }

  ReservedDomain domain;
  Process server{
      {cohort_program(), "serve", demo_experiment(), "--duration", "10", "--paused", "--domain", domain.text()},
      {{"COHORT_LOG", "info"}}};
  SeenTicks observer{domain.number()};
};

TEST_F(DisturbedRun, AKilledAndRestartedControllerKeepsTheBits) {
  const auto steady = start_controllers("0..7");
  const auto killed = start_controllers("8..15");
  control(domain, {"step", "200"});
  killed->signal(SIGKILL);
  control(domain, {"resume"});
  ASSERT_TRUE(server.wait_for_output("waiting for explorers/sbot_8 and 7 more")) << server.output();
  const std::uint64_t blocked_at = observer.tick();
  const auto restarted = start_controllers("8..15");
  EXPECT_TRUE(observer.wait_for_tick(blocked_at + 50)) << server.output();
  expect_undisturbed_end();
  EXPECT_EQ(restarted->wait_for_exit(), 0) << restarted->output();
  EXPECT_EQ(steady->wait_for_exit(), 0) << steady->output();
}

TEST_F(DisturbedRun, AControllerStoppedForThreeSecondsKeepsTheBits) {
  const auto steady = start_controllers("0..7");
  const auto stopped = start_controllers("8..15");
  control(domain, {"step", "200"});
  stopped->signal(SIGSTOP);
  control(domain, {"resume"});
  const auto stopped_at = std::chrono::steady_clock::now();
  EXPECT_TRUE(server.wait_for_output("waiting for explorers/sbot_8 and 7 more")) << server.output();
  std::this_thread::sleep_until(stopped_at + 3s);
  stopped->signal(SIGCONT);
  expect_undisturbed_end();
  EXPECT_EQ(stopped->wait_for_exit(), 0) << stopped->output();
}

TEST(ALateControllerIsNamed, CohortRunRestartsAKilledController) {
  const std::string expected = reference_hash(10);
  const ReservedDomain domain;
  Process run({cohort_program(), "run", demo_experiment(), "--duration", "10", "--paused", "--domain", domain.text()});
  eventually([&] { return !children_of(run.pid()).empty(); });
  const auto children = children_of(run.pid());
  ASSERT_EQ(children.size(), 1u);
  control(domain, {"step", "200"});
  kill(children[0], SIGKILL);
  control(domain, {"resume"});
  EXPECT_TRUE(run.wait_for_output("restarting it")) << run.output();
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
  EXPECT_NE(run.output().find(expected), std::string::npos) << run.output();
}

}  // namespace
}  // namespace cohort::test
