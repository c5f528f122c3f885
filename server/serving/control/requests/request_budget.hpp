// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace cohort::session {

/// The share of a run's time that requests may take: a quarter, which the requesters share equally. The time of a
/// request is added to the debt of its account; debts decrease by a third of the time in which the run progresses. An
/// account whose debt exceeds a small allowance has to wait, so first and occasional requests never wait. Pure logic
/// with an injected clock. Not thread-safe.
class RequestBudget {
 public:
  using Time = std::chrono::nanoseconds;  ///< from a steady clock
  static constexpr Time allowance = std::chrono::milliseconds(20);
  static constexpr Time largest_debt = std::chrono::seconds(10);
  /// A new run that has not made a step blocks further restarts by the same account for at most this time.
  static constexpr Time longest_restart = std::chrono::seconds(1);

  /// Returns true if the account's next request may be carried out now.
  bool allows(const std::string& account, Time now);
  /// Charges the account for a request that took `took` and ended at `now`.
  void charge(const std::string& account, Time took, Time now);

  /// Notes that a request of the account has ended the run to start another one. The account is charged for the time up
  /// to the first boundary of the new run.
  void begin_restart(const std::string& account, Time now);
  /// Notes that the run is at a boundary; `has_stepped`: the run has made at least one step.
  void note_boundary(bool has_stepped, Time now);
  /// Returns true if the account may restart the run now: the run that it started last must have made a step.
  bool allows_restart(const std::string& account, Time now);

 private:
  void advance(Time now);

  std::map<std::string, Time> debts_;  // all are positive
  Time advanced_to_{0};
  struct Restart {
    std::string account;
    Time began{0};
    bool is_charged = false;
  };
  std::optional<Restart> restart_;  // set while the new run has not made a step
};

}  // namespace cohort::session
