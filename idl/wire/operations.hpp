#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client_sdk/include/cohort/types.hpp"

/// The operations by which clients control a run: docs/protocol.md, "Control". Each is a struct with the fields that it
/// has: `code` is its number, `Returned` what its Reply brings beside what every Reply says. Entities are called by
/// their scoped names. Poses, twists, forces and torques are of the world frame, in SI units.
namespace cohort::wire {

enum class OperationCode : std::uint32_t {
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
std::string name_of(OperationCode operation);
/// One that changes nothing of the world, and so is answered at once.
bool is_query(OperationCode operation);
/// One that only looks on, and so is anybody's who is let in; all others need the right to control.
bool is_looking_on(OperationCode operation);

// The values that clients see too.
using cohort::Quaternion;
using cohort::SimulationState;
using cohort::Vector3;
using Pose = WorldPose;
using cohort::Twist;

// What operations return.

struct SimulatorFeatures {
  std::vector<std::uint32_t> features{};  ///< numbers of simulation_interfaces/msg/SimulatorFeatures
  std::vector<std::string> spawn_formats{};
  bool operator==(const SimulatorFeatures&) const = default;
};

struct EntityNames {
  std::vector<std::string> entities{};
  bool operator==(const EntityNames&) const = default;
};

/// The entity that an operation was done to.
struct EntityName {
  std::string entity{};  ///< of one that was spawned, the name that it got
  bool operator==(const EntityName&) const = default;
};

struct EntityState {
  std::string entity{};
  Pose pose{};
  Twist twist{};
  bool operator==(const EntityState&) const = default;
};

struct ControllerStatus {
  std::string label{};  ///< controller, process and host, for people
  std::uint64_t client = 0;
  std::vector<std::uint32_t> robots{};  ///< ids
  bool alive = false;
  bool awaited = false;         ///< the barrier waits for it
  std::int64_t awaited_ns = 0;  ///< for so long
  std::uint64_t due_tick = 0;   ///< of its oldest frame without an answer; of the next one if there is none
  std::uint64_t answers = 0;
  std::uint64_t late = 0;  ///< misses
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;        ///< frames sent again
  std::int64_t answer_p50_ns = 0;  ///< from the first sending of a frame to its answer
  std::int64_t answer_p99_ns = 0;
  bool operator==(const ControllerStatus&) const = default;
};

struct SimulationStatus {
  std::string experiment{};
  std::uint64_t seed = 0;
  bool started = false;  ///< false while controllers are missing at the start
  std::int64_t step_ns = 0;
  std::int64_t duration_ns = 0;  ///< simulated, of the whole run
  double speed = 0.0;            ///< simulated seconds per second at the most; 0: as fast as it goes
  double real_time_factor = 0.0;
  std::uint64_t state_hash = 0;
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;     ///< robots
  std::vector<std::string> awaited{};  ///< names of the first of them
  std::int64_t waiting_ns = 0;         ///< since the frames of this tick went out
  std::vector<ControllerStatus> controllers{};
  bool operator==(const SimulationStatus&) const = default;
};

/// Bytes of a snapshot or a recording.
struct DataPart {
  std::uint64_t size = 0;    ///< of all data [bytes]; of a recording that may grow, 0
  std::uint64_t offset = 0;  ///< of this part
  std::vector<std::uint8_t> data{};
  bool operator==(const DataPart&) const = default;
};

struct HistoryPart {
  std::uint64_t revision = 0;        ///< to ask with next
  std::uint64_t newest = 0;          ///< revision of the run
  std::vector<std::uint8_t> data{};  ///< a cohort_msgs/RunHistory in CDR
  bool operator==(const HistoryPart&) const = default;
};

// The operations.

struct GetSimulatorFeatures {
  static constexpr auto code = OperationCode::get_simulator_features;
  using Returned = SimulatorFeatures;
  bool operator==(const GetSimulatorFeatures&) const = default;
};

/// A question that every Reply answers.
struct GetSimulationState {
  static constexpr auto code = OperationCode::get_simulation_state;
  using Returned = std::monostate;
  bool operator==(const GetSimulationState&) const = default;
};

struct SetSimulationState {
  static constexpr auto code = OperationCode::set_simulation_state;
  using Returned = std::monostate;
  SimulationState state = SimulationState::stopped;
  bool operator==(const SetSimulationState&) const = default;
};

/// So many steps of a paused run, which is paused again then.
struct StepSimulation {
  static constexpr auto code = OperationCode::step_simulation;
  using Returned = std::monostate;
  std::uint64_t steps = 1;  ///< from 1 to 2^62
  bool operator==(const StepSimulation&) const = default;
};

/// Another run from the beginning.
struct ResetSimulation {
  static constexpr auto code = OperationCode::reset_simulation;
  using Returned = std::monostate;
  std::uint32_t scope = 0;              ///< 0 or 255: all
  std::optional<std::uint64_t> seed{};  ///< the run's if absent
  bool operator==(const ResetSimulation&) const = default;
};

struct GetEntities {
  static constexpr auto code = OperationCode::get_entities;
  using Returned = EntityNames;
  std::string filter{};  ///< POSIX extended regular expression that a part of the name matches
  bool operator==(const GetEntities&) const = default;
};

struct GetEntityState {
  static constexpr auto code = OperationCode::get_entity_state;
  using Returned = EntityState;
  std::string entity{};
  bool operator==(const GetEntityState&) const = default;
};

/// Puts an entity elsewhere, at rest, and then gives it a velocity.
struct SetEntityState {
  static constexpr auto code = OperationCode::set_entity_state;
  using Returned = EntityName;
  std::string entity{};
  std::optional<Pose> pose{};    ///< stays as it is if absent
  std::optional<Twist> twist{};  ///< likewise; one of both has to be there
  bool operator==(const SetEntityState&) const = default;
};

/// A new entity, at rest. Of the two ways to give its model, `resource_string` counts if it is not empty.
struct SpawnEntity {
  static constexpr auto code = OperationCode::spawn_entity;
  using Returned = EntityName;
  std::string entity{};
  bool allow_renaming = false;    ///< another name if this one is taken
  std::string uri{};              ///< name of one of the world's models
  std::string resource_string{};  ///< text of a model in SDF, URDF or YAML
  Pose pose{};
  std::string team{};  ///< of a robot; empty: the only team, or the only one with robots of this model
  bool operator==(const SpawnEntity&) const = default;
};

struct DeleteEntity {
  static constexpr auto code = OperationCode::delete_entity;
  using Returned = EntityName;
  std::string entity{};
  bool operator==(const DeleteEntity&) const = default;
};

struct GetStatus {
  static constexpr auto code = OperationCode::get_status;
  using Returned = SimulationStatus;
  bool operator==(const GetStatus&) const = default;
};

struct SetSpeed {
  static constexpr auto code = OperationCode::set_speed;
  using Returned = std::monostate;
  double speed = 0.0;  ///< simulated seconds per second at the most; 0: as fast as it goes
  bool operator==(const SetSpeed&) const = default;
};

struct SetLight {
  static constexpr auto code = OperationCode::set_light;
  using Returned = EntityName;
  std::string entity{};  ///< `object/light`, an object for all of its lights, or a light of the world
  bool on = false;
  std::optional<double> intensity{};  ///< >= 0 [1]; stays as it is if absent
  std::optional<Vector3> color{};     ///< red, green and blue from 0 to 1; likewise
  bool operator==(const SetLight&) const = default;
};

/// A force and a torque at a link's centre of mass, from this boundary on.
struct ApplyForce {
  static constexpr auto code = OperationCode::apply_force;
  using Returned = EntityName;
  std::string entity{};
  std::string link{};  ///< empty: the root link
  Vector3 force{};     ///< [N], in the world's axes
  Vector3 torque{};    ///< [N m], in the world's axes
  std::int64_t duration_ns = 0;
  bool operator==(const ApplyForce&) const = default;
};

/// Returns the `size` of the snapshot, whose parts GetData brings.
struct SaveSnapshot {
  static constexpr auto code = OperationCode::save_snapshot;
  using Returned = DataPart;
  bool operator==(const SaveSnapshot&) const = default;
};

struct GetData {
  static constexpr auto code = OperationCode::get_data;
  using Returned = DataPart;
  std::uint64_t offset = 0;  ///< of the part that is wanted [bytes]
  bool operator==(const GetData&) const = default;
};

/// A part of a snapshot for LoadSnapshot. Returns its `size` and `offset`.
struct PutData {
  static constexpr auto code = OperationCode::put_data;
  using Returned = DataPart;
  std::uint64_t size = 0;    ///< of all data [bytes]
  std::uint64_t offset = 0;  ///< of this part
  std::vector<std::uint8_t> data{};
  bool operator==(const PutData&) const = default;
};

struct LoadSnapshot {
  static constexpr auto code = OperationCode::load_snapshot;
  using Returned = std::monostate;
  bool operator==(const LoadSnapshot&) const = default;
};

struct StartRecording {
  static constexpr auto code = OperationCode::start_recording;
  using Returned = std::monostate;
  std::string recorded{};  ///< YAML as after an experiment's `record`; empty: what the experiment says
  bool operator==(const StartRecording&) const = default;
};

struct GetRecording {
  static constexpr auto code = OperationCode::get_recording;
  using Returned = DataPart;
  std::uint64_t offset = 0;  ///< of the part that is wanted [bytes]; what is before is forgotten
  bool operator==(const GetRecording&) const = default;
};

struct StopRecording {
  static constexpr auto code = OperationCode::stop_recording;
  using Returned = std::monostate;
  bool operator==(const StopRecording&) const = default;
};

/// Another run, from the last snapshot that the server has kept at or before a time.
struct GoBack {
  static constexpr auto code = OperationCode::go_back;
  using Returned = std::monostate;
  std::int64_t duration_ns = 0;  ///< simulated, from the run's beginning
  bool operator==(const GoBack&) const = default;
};

struct GetHistory {
  static constexpr auto code = OperationCode::get_history;
  using Returned = HistoryPart;
  std::uint64_t revision = 0;  ///< after which events are wanted; 0: all
  bool operator==(const GetHistory&) const = default;
};

/// An operation of a number that this version does not know.
struct UnknownOperation {
  std::uint32_t number = 0;
  bool operator==(const UnknownOperation&) const = default;
};

using Operation = std::variant<GetSimulatorFeatures, GetSimulationState, SetSimulationState, StepSimulation,
                               ResetSimulation, GetEntities, GetEntityState, SetEntityState, SpawnEntity, DeleteEntity,
                               GetStatus, SetSpeed, SetLight, ApplyForce, SaveSnapshot, GetData, PutData, LoadSnapshot,
                               StartRecording, GetRecording, StopRecording, GoBack, GetHistory, UnknownOperation>;

using Returned = std::variant<std::monostate, SimulatorFeatures, EntityNames, EntityName, EntityState, SimulationStatus,
                              DataPart, HistoryPart>;

OperationCode code_of(const Operation& operation);

/// Calls `visit` with each text of the operation that is a name or a filter, not a document.
template <class AnyOperation, class Visit>
void for_each_name(AnyOperation& operation, const Visit& visit) {
  if constexpr (requires { operation.filter; }) visit(operation.filter);
  if constexpr (requires { operation.entity; }) visit(operation.entity);
  if constexpr (requires { operation.team; }) visit(operation.team);
  if constexpr (requires { operation.uri; }) visit(operation.uri);
  if constexpr (requires { operation.link; }) visit(operation.link);
}
/// The same with each document and what it has of data.
template <class AnyOperation, class Visit>
void for_each_document(AnyOperation& operation, const Visit& visit) {
  if constexpr (requires { operation.resource_string; }) visit(operation.resource_string);
  if constexpr (requires { operation.recorded; }) visit(operation.recorded);
  if constexpr (requires { operation.data; }) visit(operation.data);
}

}  // namespace cohort::wire
