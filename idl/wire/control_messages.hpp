// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "idl/wire/messages.hpp"
#include "idl/wire/operations.hpp"

/// The messages of cohort.idl that control a run, as C++ values: docs/protocol.md, "Control". Names, states and results
/// are those of ROS 2's simulation_interfaces where that package defines them; the numbers of Cohort's own operations
/// start at 100.
namespace cohort::wire {

/// The results of requests: docs/protocol.md, "Results", has their meaning.
enum class ResultCode : std::uint32_t {
  feature_unsupported = 0,
  ok = 1,
  not_found = 2,
  incorrect_state = 3,
  operation_failed = 4,
  // Result of SetSimulationState.
  already_in_target_state = 101,
  // Results of SpawnEntity.
  name_not_unique = 101,
  name_invalid = 102,
  no_resource = 104,
  resource_parse_error = 106,
  missing_assets = 107,
  unsupported_assets = 108,
  // Result of SetEntityState. SpawnEntity has another number for it.
  invalid_pose = 101,
  invalid_spawn_pose = 109,
  // Results of any operation, defined by Cohort.
  malformed = 200,
  not_permitted = 201,
  forgotten = 202,
  too_many_requests = 203,
  cancelled = 204,
  not_paused = 205,
  time_not_held = 206,
  unknown_model = 207,
  invalid_team = 208,
  too_many_objects = 209,
  link_not_found = 210,
  light_not_found = 211,
  immovable = 212,
  quarantined = 213,
  too_large = 214,
  invalid_snapshot = 215,
  not_saved = 216,
  already_recording = 217,
  too_many_recordings = 218,
  invalid_selection = 219,
};

/// Returns the result for a client with this minor version, which may only know a more general one.
constexpr ResultCode known_to(std::uint32_t minor, ResultCode result) {
  const bool is_new = (result >= ResultCode::resource_parse_error && result <= ResultCode::unsupported_assets) ||
                      result >= ResultCode::too_many_requests;
  if (!is_new || minor >= first_minor_with_reasons) return result;
  return result == ResultCode::time_not_held ? ResultCode::incorrect_state : ResultCode::operation_failed;
}

struct Request {
  std::uint64_t client = 0;
  std::uint32_t minor = minor_version;
  std::uint64_t number = 0;  ///< 1, 2, 3 ...; a repeated number requests the reply again
  std::string label{};       ///< human-readable name of the client
  Operation operation{};
  bool operator==(const Request&) const = default;

  OperationCode code() const { return code_of(operation); }
};

struct Reply {
  std::uint64_t client = 0;
  std::uint64_t number = 0;                                         ///< number of the request
  OperationCode operation = OperationCode::get_simulator_features;  ///< operation of the request
  ResultCode result = ResultCode::ok;
  std::string error_message{};  ///< human-readable sentence, also after success
  SimulationState state{};      ///< current state of the simulation
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;  ///< simulated
  Returned returned{};       ///< the operation's `Returned`; may be missing or empty if the request failed
  bool operator==(const Reply&) const = default;

  /// Returns true if the request has been done, or if the state was already as requested.
  bool is_done() const {
    return result == ResultCode::ok ||
           (operation == OperationCode::set_simulation_state && result == ResultCode::already_in_target_state);
  }
  /// Returns the result of the operation, or nullptr if it is not a `Value`.
  template <class Value>
  const Value* get() const {
    return std::get_if<Value>(&returned);
  }
};

/// Maximum number of requests of one client without a reply, and number of replies that the server keeps per client.
inline constexpr std::uint64_t requests_under_way = 16;
/// Data is sent in parts of at most this size [bytes], so that neither side waits long for one. Its total size is
/// limited too.
inline constexpr std::uint64_t largest_part = std::uint64_t{256} << 10;
inline constexpr std::uint64_t largest_data = std::uint64_t{256} << 20;

}  // namespace cohort::wire
