#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace cohort::session {

/// Who may send requests to a server at a time. Each identity has a limited number of slots, and each role has some
/// that the other cannot take. Where there is none left, the one that has asked for nothing for longest has to go. Pure
/// logic with an injected clock. Not thread-safe.
class RequesterSlots {
 public:
  using Time = std::chrono::nanoseconds;  ///< of a steady clock
  static constexpr std::size_t most = 64;
  static constexpr std::size_t most_of_identity = 32;
  static constexpr std::size_t kept_for_role = 16;
  /// A client that waits for a reply asks again sooner.
  static constexpr Time idle_after = std::chrono::milliseconds(1500);

  struct Holder {
    std::string identity{};    ///< empty without security
    bool may_control = false;  ///< its role; true without security
    Time used{0};
  };

  struct Admission {
    bool is_in = false;
    std::optional<std::uint64_t> leaves{};  ///< who has to go for it
  };
  /// The client asks for something. If it is not in yet it comes in, if there is room.
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
