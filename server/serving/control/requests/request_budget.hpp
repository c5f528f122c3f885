#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace cohort::session {

/// How much of a run's time requests may take: a quarter, which those who ask share equally. What a request takes is
/// the debt of its account; debts go down by a third of the time in which the run goes on. An account whose debt is
/// more than a small allowance has to wait, so first and occasional requests never do. Pure logic with an injected
/// clock. Not thread-safe.
class RequestBudget {
 public:
  using Time = std::chrono::nanoseconds;  ///< of a steady clock
  static constexpr Time allowance = std::chrono::milliseconds(20);
  static constexpr Time largest_debt = std::chrono::seconds(10);
  /// A run that cannot make its first step does not keep others from beginning another one for longer.
  static constexpr Time longest_restart = std::chrono::seconds(1);

  /// Whether the account's next request may be done now.
  bool allows(const std::string& account, Time now);
  /// A request of the account was done until `now`, and took so long.
  void charge(const std::string& account, Time took, Time now);

  /// A request of the account has ended the run for another one. The account's, until that has made a step, is the time
  /// up to its first boundary.
  void begin_restart(const std::string& account, Time now);
  /// The run stands at a boundary, after some step of its own or not.
  void note_boundary(bool has_stepped, Time now);
  /// Whether the account may end the run for another one now: that which it began last must have made a step.
  bool allows_restart(const std::string& account, Time now);

 private:
  void advance(Time now);

  std::map<std::string, Time> debts_;  // none is zero or less
  Time advanced_to_{0};
  struct Restart {
    std::string account;
    Time began{0};
    bool is_charged = false;
  };
  std::optional<Restart> restart_;  // of a run that has not made a step
};

}  // namespace cohort::session
