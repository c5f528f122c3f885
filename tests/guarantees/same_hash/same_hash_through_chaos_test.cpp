// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <random>
#include <thread>

#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

constexpr int robots = 64;
constexpr int disturbances = 48;

// Kills, stops, ends and delays processes of controllers at random, one after the other; ended ones are restarted.
class Chaos {
 public:
  explicit Chaos(const ReservedDomain& domain) : domain_(domain), controllers_(robots) {
    for (int i = 0; i < robots; ++i) start(i);
  }

  void disturb() {
    const int victim = std::uniform_int_distribution<int>(0, robots - 1)(random_);
    switch (std::uniform_int_distribution<int>(0, 3)(random_)) {
      case 0:  // killed, and started again at once
        controllers_[victim]->signal(SIGKILL);
        start(victim);
        break;
      case 1:  // told to end, and started again a while later
        controllers_[victim]->signal(SIGTERM);
        std::this_thread::sleep_for(pause(0ms, 200ms));
        start(victim);
        break;
      case 2: stop_for(victim, pause(1ms, 30ms)); break;       // late
      default: stop_for(victim, pause(300ms, 1500ms)); break;  // longer than the lease of its liveliness, or not
    }
  }
  void rest() { std::this_thread::sleep_for(pause(0ms, 60ms)); }
  std::string output_of(int i) const { return controllers_[i]->output(); }
  std::optional<int> exit_code_of(int i) { return controllers_[i]->wait_for_exit(); }

 private:
  void start(int i) {
    controllers_[i].reset();
    controllers_[i] = std::make_unique<Process>(FieldOfRobots::host(domain_, std::to_string(i)));
  }
  void stop_for(int victim, std::chrono::milliseconds time) {
    controllers_[victim]->signal(SIGSTOP);
    std::this_thread::sleep_for(time);
    controllers_[victim]->signal(SIGCONT);
  }
  std::chrono::milliseconds pause(std::chrono::milliseconds least, std::chrono::milliseconds most) {
    return std::chrono::milliseconds(std::uniform_int_distribution<std::int64_t>(least.count(), most.count())(random_));
  }

  const ReservedDomain& domain_;
  std::vector<std::unique_ptr<Process>> controllers_;
  std::mt19937 random_{20051};
};

// Under `wait`, with controllers that are functions of their observations, none of this changes the bits.
TEST(SameHashThroughChaos, OfSixtyFourKilledStoppedAndLateProcesses) {
  const FieldOfRobots field(robots, 20.0);  // 2000 ticks
  const auto quiet = run_experiment(field.file(), {"--controllers", "inprocess"});
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--speed", "4"}));
  Chaos chaos(domain);
  ASSERT_TRUE(server.wait_for_output("simulated")) << server.output();
  for (int i = 0; i < disturbances && server.running(); ++i) {
    chaos.disturb();
    chaos.rest();
  }
  EXPECT_TRUE(server.running()) << "all of it was in mid-run";
  ASSERT_EQ(server.wait_for_exit(), 0) << server.output();
  const auto summary = field.summary();
  EXPECT_EQ(summary["ticks"], 2000);
  EXPECT_EQ(summary["state_hash"], quiet["state_hash"]);
  EXPECT_GT(events_of(summary, "joined").size(), static_cast<std::size_t>(robots + 10)) << "some were started again";
  EXPECT_EQ(events_of(summary, "missed").size(), 0u);
  for (int i = 0; i < robots; ++i) EXPECT_EQ(chaos.exit_code_of(i), 0) << i << ": " << chaos.output_of(i);
}

}  // namespace
}  // namespace cohort::test
