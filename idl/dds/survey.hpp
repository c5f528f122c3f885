#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "idl/dds/participant.hpp"

/// What there is on a domain, for whoever looks for what is wrong.
namespace cohort::wire {

/// The major version of the protocol that a topic belongs to: 2 for `cohort/v2/join`. None if it is no topic of
/// Cohort's.
std::optional<std::uint32_t> major_version_of(std::string_view topic);

/// Tells of endpoints of other major versions, which never match ours. `callback` gets the version, on a thread of
/// DDS, once for each endpoint; it must not throw nor block for long.
class VersionWatch {
 public:
  VersionWatch(Participant& participant, std::function<void(std::uint32_t major)> callback);
  VersionWatch(VersionWatch&&) noexcept;
  VersionWatch& operator=(VersionWatch&&) noexcept;
  ~VersionWatch();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct Survey {
  bool has_server = false;             ///< of our major version, and it lets us in
  std::set<std::uint32_t> majors{};    ///< others that are there
  std::set<std::string> models{};      ///< kinds of robots that the server has
  std::optional<std::uint32_t> run{};  ///< of the newest WorldState, if one came
  std::uint64_t tick = 0;              ///< the same
};

/// Looks at the server of `domain` at `address` as an observer, for as long as `patience` or until it is known. With
/// `identity` at that identity's door, where controllers are not shown the state of the world. Throws WireError.
Survey survey(std::uint32_t domain, const std::string& address, const std::optional<Identity>& identity,
              std::chrono::milliseconds patience);

/// The version of Cyclone DDS that this was built with, and the library that is in use.
std::string dds_version();
std::filesystem::path dds_library();

}  // namespace cohort::wire
