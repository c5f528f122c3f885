// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace cohort::session {

/// The clients that may send requests to a server at the same time. Each identity has a limited number of slots, and
/// some slots are reserved for each role. If none is free, the client that has been idle for the longest time loses its
/// slot. Pure logic with an injected clock. Not thread-safe.
class RequesterSlots {
 public:
  using Time = std::chrono::nanoseconds;  ///< from a steady clock
  static constexpr std::size_t most = 64;
  static constexpr std::size_t most_of_identity = 32;
  static constexpr std::size_t kept_for_role = 16;
  /// A client counts as idle after this time: one that waits for a reply repeats its request earlier.
  static constexpr Time idle_after = std::chrono::milliseconds(1500);

  struct Holder {
    std::string identity{};    ///< empty without security
    bool may_control = false;  ///< its role; true without security
    Time used{0};
  };

  struct Admission {
    bool is_in = false;
    std::optional<std::uint64_t> leaves{};  ///< the client that loses its slot
  };
  /// Notes a request of the client, and gives it a slot if it has none and one is available.
  Admission use(std::uint64_t client, const std::string& identity, bool may_control, Time now);
  void leave(std::uint64_t client) { holders_.erase(client); }

 private:
  template <class Condition>
  std::size_t count(const Condition& condition) const;
  template <class Condition>
  Admission replace_idle(std::uint64_t client, const Holder& holder, const Condition& may_go);

  std::map<std::uint64_t, Holder> holders_;  // by client
};

}  // namespace cohort::session
