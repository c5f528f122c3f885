// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/request_budget.hpp"

#include <algorithm>

namespace cohort::session {
namespace {

constexpr int run_to_requests = 3;  // ratio of the run's share of the time to that of requests

}  // namespace

bool RequestBudget::allows(const std::string& account, Time now) {
  advance(now);
  const auto found = debts_.find(account);
  return found == debts_.end() || found->second <= allowance;
}

void RequestBudget::charge(const std::string& account, Time took, Time now) {
  advance(now - took);
  advanced_to_ = std::max(advanced_to_, now);  // debts do not decrease while a request is carried out
  if (took <= Time::zero()) return;
  Time& debt = debts_[account];
  debt = std::min(debt + took, largest_debt);
}

void RequestBudget::begin_restart(const std::string& account, Time now) { restart_ = Restart{account, now}; }

void RequestBudget::note_boundary(bool has_stepped, Time now) {
  if (!restart_) return;
  if (!std::exchange(restart_->is_charged, true))
    charge(restart_->account, std::min(now - restart_->began, longest_restart), now);
  if (has_stepped) restart_.reset();
}

bool RequestBudget::allows_restart(const std::string& account, Time now) {
  if (restart_ && restart_->account == account && now - restart_->began < longest_restart) return false;
  return allows(account, now);
}

// Reduces all debts equally until the smallest is paid, then shares the rest among the others, and so on.
void RequestBudget::advance(Time now) {
  if (now <= advanced_to_) return;
  Time left = (now - advanced_to_) / run_to_requests;
  advanced_to_ = now;
  while (!debts_.empty() && left > Time::zero()) {
    Time paid = std::max(left / static_cast<Time::rep>(debts_.size()), Time(1));
    for (const auto& [account, debt] : debts_) paid = std::min(paid, debt);
    left -= paid * static_cast<Time::rep>(debts_.size());
    for (auto& [account, debt] : debts_) debt -= paid;
    std::erase_if(debts_, [](const auto& each) { return each.second <= Time::zero(); });
  }
}

}  // namespace cohort::session
