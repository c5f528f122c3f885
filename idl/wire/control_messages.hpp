#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "idl/wire/messages.hpp"
#include "idl/wire/operations.hpp"

/// The messages of cohort.idl that control a running world, as C++ values: docs/protocol.md, "Control". Names, states
/// and results are those of ROS 2's simulation_interfaces where it has a word; what it has none for is from 100 on.
namespace cohort::wire {

enum class ResultCode : std::uint32_t {
  feature_unsupported = 0,
  ok = 1,
  not_found = 2,
  incorrect_state = 3,
  operation_failed = 4,
  // Of SetSimulationState.
  already_in_target_state = 101,
  // Of SpawnEntity.
  name_not_unique = 101,
  name_invalid = 102,
  no_resource = 104,
  // Of SetEntityState. SpawnEntity's has another number.
  invalid_pose = 101,
  invalid_spawn_pose = 109,
  // Ours, of any operation.
  malformed = 200,
  not_permitted = 201,
  forgotten = 202,
};

struct Request {
  std::uint64_t client = 0;
  std::uint32_t minor = minor_version;
  std::uint64_t number = 0;  ///< 1, 2, 3 ...; the same again asks for the reply once more
  std::string label{};       ///< who asks, for people
  Operation operation{};
  bool operator==(const Request&) const = default;

  OperationCode code() const { return code_of(operation); }
};

struct Reply {
  std::uint64_t client = 0;
  std::uint64_t number = 0;                                         ///< of the request
  OperationCode operation = OperationCode::get_simulator_features;  ///< of the request
  ResultCode result = ResultCode::ok;
  std::string error_message{};  ///< a sentence for people, also when all went well
  SimulationState state{};      ///< of the simulation now
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;  ///< simulated
  Returned returned{};       ///< of the operation's `Returned`; may be missing or empty if it was not done
  bool operator==(const Reply&) const = default;

  /// What was asked for is so, if only since it was before.
  bool is_done() const {
    return result == ResultCode::ok ||
           (operation == OperationCode::set_simulation_state && result == ResultCode::already_in_target_state);
  }
  /// What the operation returned, or nullptr if that is not a `Value`.
  template <class Value>
  const Value* get() const {
    return std::get_if<Value>(&returned);
  }
};

/// How many requests of one client may be without a reply, and how many replies the server remembers of each.
inline constexpr std::uint64_t requests_under_way = 16;
/// Data goes in parts, of at most this size each [bytes], so that neither side waits long for one; and in all it has at
/// most so many.
inline constexpr std::uint64_t largest_part = std::uint64_t{256} << 10;
inline constexpr std::uint64_t largest_data = std::uint64_t{256} << 20;

}  // namespace cohort::wire
