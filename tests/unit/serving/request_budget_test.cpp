// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/request_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace cohort::session {
namespace {

using namespace std::chrono_literals;
using Time = RequestBudget::Time;

// A run whose ticks take a millisecond, and accounts that ask for something as often as they may at each boundary.
class FloodedRun {
 public:
  explicit FloodedRun(std::vector<Time> costs) : costs_(std::move(costs)), taken_(costs_.size()) {}
  void go_on_for(Time time) {
    for (const Time end = now_ + time; now_ < end;) {
      for (std::size_t i = 0; i < costs_.size(); ++i)
        while (budget_.allows(name_of(i), now_)) {
          now_ += costs_[i];
          taken_[i] += costs_[i];
          budget_.charge(name_of(i), costs_[i], now_);
        }
      now_ += 1ms;
      run_ += 1ms;
    }
  }
  void begin_counting() {
    run_ = 0ms;
    std::ranges::fill(taken_, 0ms);
  }
  Time run() const { return run_; }
  Time taken(std::size_t account) const { return taken_[account]; }

 private:
  static std::string name_of(std::size_t account) { return std::to_string(account); }
  RequestBudget budget_;
  std::vector<Time> costs_;
  std::vector<Time> taken_;
  Time now_ = 1h;
  Time run_{0};
};

TEST(RequestBudget, LeavesTheRunThreeQuartersOfItsTime) {
  for (const auto& costs : {std::vector<Time>{5ms}, {300ms}, {100us}, {2ms, 2ms, 2ms}, {1ms, 90ms, 10ms, 20us}}) {
    FloodedRun flooded(costs);
    flooded.go_on_for(10s);
    flooded.begin_counting();
    flooded.go_on_for(100s);
    EXPECT_GT(flooded.run(), 70s) << costs.size() << " accounts";
    EXPECT_LT(flooded.run(), 80s) << costs.size() << " accounts: the rest is the requests'";
  }
}

TEST(RequestBudget, IsSharedEquallyBetweenAccounts) {
  FloodedRun flooded({1ms, 50ms, 10ms});
  flooded.go_on_for(100s);
  for (std::size_t account = 0; account < 3; ++account)
    EXPECT_NEAR(std::chrono::duration<double>(flooded.taken(account)).count(), 25.0 / 3.0, 1.5) << account;
}

TEST(RequestBudget, DelaysNoAccountForOthersOrForSmallOrOldDebts) {
  RequestBudget budget;
  budget.charge("flood", 5s, 10s);
  EXPECT_FALSE(budget.allows("flood", 10s));
  EXPECT_TRUE(budget.allows("operator", 10s));
  budget.charge("operator", 15ms, 10s);
  EXPECT_TRUE(budget.allows("operator", 10s)) << "within the allowance";
  budget.charge("operator", 45ms, 10s);
  EXPECT_FALSE(budget.allows("operator", 10s));
  EXPECT_FALSE(budget.allows("operator", 10s + 200ms)) << "half of a third of that is paid";
  EXPECT_TRUE(budget.allows("operator", 10s + 250ms));
  EXPECT_FALSE(budget.allows("flood", 20s));
  EXPECT_TRUE(budget.allows("flood", 26s));
}

TEST(RequestBudget, ARestartedRunMakesAStepBeforeItsAccountRestartsAgain) {
  RequestBudget budget;
  budget.begin_restart("flood", 10s);
  EXPECT_FALSE(budget.allows_restart("flood", 10s + 1ms));
  EXPECT_TRUE(budget.allows_restart("operator", 10s + 1ms));
  budget.note_boundary(false, 10s + 100ms);
  EXPECT_FALSE(budget.allows_restart("flood", 10s + 101ms));
  budget.note_boundary(true, 10s + 102ms);
  EXPECT_FALSE(budget.allows_restart("flood", 10s + 103ms)) << "it took a tenth of a second";
  EXPECT_TRUE(budget.allows_restart("flood", 10s + 400ms));
  // One that waits for its controllers, and so makes no step, may be replaced.
  budget.begin_restart("flood", 20s);
  EXPECT_FALSE(budget.allows_restart("flood", 20s + 900ms));
  EXPECT_TRUE(budget.allows_restart("flood", 21s));
}

}  // namespace
}  // namespace cohort::session
