#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/wire/messages.hpp"

/// The messages of cohort.idl that control a running world, as C++ values: docs/protocol.md, "Control". Names, states
/// and results are those of ROS 2's simulation_interfaces where it has a word; what it has none for is from 100 on.
namespace cohort::wire {

enum class Operation : std::uint32_t {
  get_simulator_features = 0,
  get_simulation_state = 1,
  set_simulation_state = 2,
  step_simulation = 3,
  reset_simulation = 4,
  get_entities = 5,
  get_entity_state = 6,
  set_entity_state = 7,
  spawn_entity = 8,
  delete_entity = 9,
  get_status = 100,
  set_speed = 101,
  set_light = 102,
  apply_force = 103,
  save_snapshot = 104,
  get_data = 105,
  put_data = 106,
  load_snapshot = 107,
  start_recording = 108,
  get_recording = 109,
  stop_recording = 110,
  go_back = 111,
  get_history = 112,
};

/// The operation's name in docs/protocol.md, such as `StepSimulation`; empty if there is none of this number.
std::string name_of(Operation operation);
/// One that changes nothing of the world, and so is answered at once.
bool is_query(Operation operation);
/// One that only looks on, and so is anybody's who is let in; all others need the right to control.
bool is_looking_on(Operation operation);

enum class SimulationState : std::uint32_t { stopped = 0, playing = 1, paused = 2, quitting = 3 };

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

struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Vector3&) const = default;
};

struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  bool operator==(const Quaternion&) const = default;
};

struct Pose {
  Vector3 position{};
  Quaternion orientation{};
  bool operator==(const Pose&) const = default;
};

struct Twist {
  Vector3 linear{};
  Vector3 angular{};
  bool operator==(const Twist&) const = default;
};

struct EntityState {
  std::string entity{};
  Pose pose{};
  Twist twist{};
  bool operator==(const EntityState&) const = default;
};

struct ControllerStatus {
  std::string label{};
  std::uint64_t client = 0;
  std::vector<std::uint32_t> robots{};
  bool alive = false;
  bool awaited = false;
  std::int64_t awaited_ns = 0;
  std::uint64_t due_tick = 0;
  std::uint64_t answers = 0;
  std::uint64_t late = 0;
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;
  std::int64_t answer_p50_ns = 0;
  std::int64_t answer_p99_ns = 0;
  bool operator==(const ControllerStatus&) const = default;
};

struct SimulationStatus {
  std::string experiment{};
  std::uint64_t seed = 0;
  bool started = false;
  std::int64_t step_ns = 0;
  std::int64_t duration_ns = 0;
  double speed = 0.0;
  double real_time_factor = 0.0;
  std::uint64_t state_hash = 0;
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;
  std::vector<std::string> awaited{};
  std::int64_t waiting_ns = 0;
  std::vector<ControllerStatus> controllers{};
  bool operator==(const SimulationStatus&) const = default;
};

struct Request {
  std::uint64_t client = 0;
  std::uint32_t minor = minor_version;
  std::uint64_t number = 0;
  Operation operation{};
  std::string label{};
  SimulationState state{};
  std::uint32_t scope = 0;
  bool set_seed = false;
  std::uint64_t seed = 0;
  std::uint64_t steps = 0;
  double speed = 0.0;
  std::string filter{};
  std::string entity{};
  bool allow_renaming = false;
  std::string uri{};
  std::string resource_string{};
  bool set_pose = false;
  Pose pose{};
  bool set_twist = false;
  Twist twist{};
  bool on = false;
  bool set_intensity = false;
  double intensity = 0.0;
  bool set_color = false;
  Vector3 color{};
  std::string link{};
  Vector3 force{};
  Vector3 torque{};
  std::int64_t duration_ns = 0;
  std::uint64_t size = 0;
  std::uint64_t offset = 0;
  std::vector<std::uint8_t> data{};
  bool operator==(const Request&) const = default;
};

struct Reply {
  std::uint64_t client = 0;
  std::uint64_t number = 0;
  Operation operation{};
  ResultCode result = ResultCode::ok;
  std::string error_message{};
  SimulationState state{};
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::string entity{};
  std::vector<std::uint32_t> features{};
  std::vector<std::string> spawn_formats{};
  std::vector<std::string> entities{};
  std::vector<EntityState> states{};
  std::vector<SimulationStatus> status{};
  std::uint64_t size = 0;
  std::uint64_t offset = 0;
  std::vector<std::uint8_t> data{};
  bool operator==(const Reply&) const = default;

  /// What was asked for is so, if only since it was before.
  bool is_done() const {
    return result == ResultCode::ok ||
           (operation == Operation::set_simulation_state && result == ResultCode::already_in_target_state);
  }
};

/// How many requests of one client may be without a reply, and how many replies the server remembers of each.
inline constexpr std::uint64_t requests_under_way = 16;
/// Data goes in parts, of at most this size each [bytes], so that neither side waits long for one; and in all it has at
/// most so many.
inline constexpr std::uint64_t largest_part = std::uint64_t{256} << 10;
inline constexpr std::uint64_t largest_data = std::uint64_t{256} << 20;

}  // namespace cohort::wire
