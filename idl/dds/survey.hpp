// SPDX-License-Identifier: Apache-2.0
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

/// Information about a domain, for diagnosis.
namespace cohort::wire {

/// Returns the major version of the protocol of a topic: 2 for `cohort/v2/join`. Returns nothing if this is not a topic
/// of Cohort.
std::optional<std::uint32_t> major_version_of(std::string_view topic);

/// Reports endpoints of other major versions, which never match ours. Calls `callback` with the version, on a DDS
/// thread, once for each endpoint; it must not throw nor block for long.
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
  bool has_server = false;             ///< with our major version, and it admits us
  std::set<std::uint32_t> majors{};    ///< other major versions on the domain
  std::set<std::string> models{};      ///< models of the server's robots
  std::optional<std::uint32_t> run{};  ///< run of the newest WorldState, if one arrived
  std::uint64_t tick = 0;              ///< tick of the newest WorldState
};

/// Looks for the server of `domain` at `address` as an observer, at most for `patience`. With `identity`, uses the
/// server's participant for it, where controllers do not receive the state of the world. Throws WireError.
Survey survey(std::uint32_t domain, const std::string& address, const std::optional<Identity>& identity,
              std::chrono::milliseconds patience);

/// Returns the version of Cyclone DDS that this program was built with.
std::string dds_version();
/// Returns the path of the library of Cyclone DDS that is in use.
std::filesystem::path dds_library();

}  // namespace cohort::wire
