// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "idl/include/cohort/types.hpp"

/// The operations with which clients control a run: docs/protocol.md, "Control". Each is a struct of its fields. `code`
/// is its number, and `Returned` the type of its result, in addition to the common fields of every Reply. Entities are
/// identified by their scoped names. Poses, twists, forces and torques are in the world frame, in SI units.
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
  advance_time = 113,
  get_experiment = 114,
};

/// Returns the operation's name in docs/protocol.md, such as `StepSimulation`; empty if there is none with this number.
std::string name_of(OperationCode operation);
/// Returns true for an operation that does not change the world, and so is answered at once.
bool is_query(OperationCode operation);
/// Returns true for an operation that only observes, which every admitted client may do; others need the right to
/// control.
bool is_looking_on(OperationCode operation);

// Values of the public headers.
using cohort::Quaternion;
using cohort::SimulationState;
using cohort::Vector3;
using Pose = WorldPose;
using cohort::Twist;

// Results of operations

struct SimulatorFeatures {
  std::vector<std::uint32_t> features{};  ///< numbers of simulation_interfaces/msg/SimulatorFeatures
  std::vector<std::string> spawn_formats{};
  bool operator==(const SimulatorFeatures&) const = default;
};

struct EntityNames {
  std::vector<std::string> entities{};
  bool operator==(const EntityNames&) const = default;
};

/// The entity of an operation.
struct EntityName {
  std::string entity{};  ///< for a spawned entity, its actual name
  bool operator==(const EntityName&) const = default;
};

struct EntityState {
  std::string entity{};
  Pose pose{};
  Twist twist{};
  bool operator==(const EntityState&) const = default;
};

struct ControllerStatus {
  std::string label{};  ///< human-readable: controller, process and host
  std::uint64_t client = 0;
  std::vector<std::uint32_t> robots{};  ///< ids
  bool alive = false;
  bool awaited = false;         ///< true if the barrier waits for it
  std::int64_t awaited_ns = 0;  ///< how long the barrier has waited for it
  std::uint64_t due_tick = 0;   ///< tick of its oldest unanswered frame; of the next frame if all are answered
  std::uint64_t answers = 0;
  std::uint64_t late = 0;  ///< number of missed deadlines
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;        ///< number of frames sent again
  std::int64_t answer_p50_ns = 0;  ///< from the first sending of a frame to its answer
  std::int64_t answer_p99_ns = 0;
  bool operator==(const ControllerStatus&) const = default;
};

struct SimulationStatus {
  std::string experiment{};
  std::uint64_t seed = 0;
  bool started = false;  ///< false while controllers are missing at the start
  std::int64_t step_ns = 0;
  std::int64_t duration_ns = 0;  ///< simulated duration of the whole run
  double speed = 0.0;            ///< limit of simulated seconds per second; 0: no limit
  double real_time_factor = 0.0;
  std::uint64_t state_hash = 0;
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;     ///< number of robots that the run waits for
  std::vector<std::string> awaited{};  ///< names of the first of these robots
  std::int64_t waiting_ns = 0;         ///< time since the frames of this tick were sent
  std::vector<ControllerStatus> controllers{};
  bool operator==(const SimulationStatus&) const = default;
};

/// Bytes of a snapshot, a recording or an experiment.
struct DataPart {
  std::uint64_t size = 0;    ///< total size [bytes]; 0 for a recording that may grow
  std::uint64_t offset = 0;  ///< offset of this part [bytes]
  std::vector<std::uint8_t> data{};
  bool operator==(const DataPart&) const = default;
};

struct HistoryPart {
  std::uint64_t revision = 0;        ///< revision for the next query
  std::uint64_t newest = 0;          ///< revision of the run
  std::vector<std::uint8_t> data{};  ///< a cohort_msgs/RunHistory in CDR
  bool operator==(const HistoryPart&) const = default;
};

// Operations

struct GetSimulatorFeatures {
  static constexpr auto code = OperationCode::get_simulator_features;
  using Returned = SimulatorFeatures;
  bool operator==(const GetSimulatorFeatures&) const = default;
};

/// A query without a result of its own: every Reply contains the state.
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

/// Advances a paused run by a number of steps; it is paused again after them.
struct StepSimulation {
  static constexpr auto code = OperationCode::step_simulation;
  using Returned = std::monostate;
  std::uint64_t steps = 1;  ///< from 1 to 2^62
  bool operator==(const StepSimulation&) const = default;
};

/// Restarts the run from the beginning.
struct ResetSimulation {
  static constexpr auto code = OperationCode::reset_simulation;
  using Returned = std::monostate;
  std::uint32_t scope = 0;              ///< 0 or 255: all
  std::optional<std::uint64_t> seed{};  ///< the run's seed if absent
  bool operator==(const ResetSimulation&) const = default;
};

struct GetEntities {
  static constexpr auto code = OperationCode::get_entities;
  using Returned = EntityNames;
  std::string filter{};  ///< POSIX extended regular expression that matches a part of the name
  bool operator==(const GetEntities&) const = default;
};

struct GetEntityState {
  static constexpr auto code = OperationCode::get_entity_state;
  using Returned = EntityState;
  std::string entity{};
  bool operator==(const GetEntityState&) const = default;
};

/// Moves an entity to a pose, at rest, and then sets its velocity.
struct SetEntityState {
  static constexpr auto code = OperationCode::set_entity_state;
  using Returned = EntityName;
  std::string entity{};
  std::optional<Pose> pose{};    ///< unchanged if absent
  std::optional<Twist> twist{};  ///< unchanged if absent; at least one of the two must be present
  bool operator==(const SetEntityState&) const = default;
};

/// Adds an entity, at rest. Its model is `resource_string` if that is not empty, otherwise `uri`.
struct SpawnEntity {
  static constexpr auto code = OperationCode::spawn_entity;
  using Returned = EntityName;
  std::string entity{};
  bool allow_renaming = false;    ///< chooses another name if this one is taken
  std::string uri{};              ///< name of one of the world's models
  std::string resource_string{};  ///< text of a model in SDF, URDF or YAML
  Pose pose{};
  std::string team{};  ///< team of a robot; if empty, the only team, or the only one with robots of this model
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
  double speed = 0.0;  ///< limit of simulated seconds per second; 0: no limit
  bool operator==(const SetSpeed&) const = default;
};

struct SetLight {
  static constexpr auto code = OperationCode::set_light;
  using Returned = EntityName;
  std::string entity{};  ///< `object/light`, an object for all of its lights, or a light of the world
  bool on = false;
  std::optional<double> intensity{};  ///< >= 0 [1]; unchanged if absent
  std::optional<Vector3> color{};     ///< red, green and blue from 0 to 1; unchanged if absent
  bool operator==(const SetLight&) const = default;
};

/// Applies a force and a torque at a link's centre of mass, from this boundary on.
struct ApplyForce {
  static constexpr auto code = OperationCode::apply_force;
  using Returned = EntityName;
  std::string entity{};
  std::string link{};  ///< root link if empty
  Vector3 force{};     ///< [N], in the world frame
  Vector3 torque{};    ///< [N m], in the world frame
  std::int64_t duration_ns = 0;
  bool operator==(const ApplyForce&) const = default;
};

/// Saves a snapshot and returns its `size`; GetData returns its parts.
struct SaveSnapshot {
  static constexpr auto code = OperationCode::save_snapshot;
  using Returned = DataPart;
  bool operator==(const SaveSnapshot&) const = default;
};

struct GetData {
  static constexpr auto code = OperationCode::get_data;
  using Returned = DataPart;
  std::uint64_t offset = 0;  ///< offset of the requested part [bytes]
  bool operator==(const GetData&) const = default;
};

/// Sends a part of a snapshot for LoadSnapshot. Returns its `size` and `offset`.
struct PutData {
  static constexpr auto code = OperationCode::put_data;
  using Returned = DataPart;
  std::uint64_t size = 0;    ///< total size [bytes]
  std::uint64_t offset = 0;  ///< offset of this part [bytes]
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
  std::string recorded{};  ///< YAML as in an experiment's `record`; if empty, the `record` of the experiment
  bool operator==(const StartRecording&) const = default;
};

struct GetRecording {
  static constexpr auto code = OperationCode::get_recording;
  using Returned = DataPart;
  std::uint64_t offset = 0;  ///< offset of the requested part [bytes]; earlier bytes are discarded
  bool operator==(const GetRecording&) const = default;
};

struct StopRecording {
  static constexpr auto code = OperationCode::stop_recording;
  using Returned = std::monostate;
  bool operator==(const StopRecording&) const = default;
};

/// Starts another run from the last snapshot that the server kept at or before a time.
struct GoBack {
  static constexpr auto code = OperationCode::go_back;
  using Returned = std::monostate;
  std::int64_t duration_ns = 0;  ///< simulated time since the start of the run
  bool operator==(const GoBack&) const = default;
};

struct GetHistory {
  static constexpr auto code = OperationCode::get_history;
  using Returned = HistoryPart;
  std::uint64_t revision = 0;  ///< revision after which events are requested; 0: all
  bool operator==(const GetHistory&) const = default;
};

/// Holds the run's time: the run advances past a tick only when each client that holds the time has requested a later
/// tick.
struct AdvanceTime {
  static constexpr auto code = OperationCode::advance_time;
  using Returned = std::monostate;
  /// Number of ticks after that of the last reply, at most 2^62; the reply is sent when the frames of that tick have
  /// been sent. 0 starts the hold, and is answered at once.
  std::uint64_t steps = 0;
  bool release = false;  ///< ends the hold instead
  bool operator==(const AdvanceTime&) const = default;
};

struct GetExperiment {
  static constexpr auto code = OperationCode::get_experiment;
  using Returned = DataPart;  ///< cohort_msgs/ExperimentFiles in CDR
  std::uint64_t offset = 0;   ///< offset of the requested part [bytes]
  bool operator==(const GetExperiment&) const = default;
};

/// An operation with a number that this version does not support.
struct UnknownOperation {
  std::uint32_t number = 0;
  bool operator==(const UnknownOperation&) const = default;
};

using Operation =
    std::variant<GetSimulatorFeatures, GetSimulationState, SetSimulationState, StepSimulation, ResetSimulation,
                 GetEntities, GetEntityState, SetEntityState, SpawnEntity, DeleteEntity, GetStatus, SetSpeed, SetLight,
                 ApplyForce, SaveSnapshot, GetData, PutData, LoadSnapshot, StartRecording, GetRecording, StopRecording,
                 GoBack, GetHistory, AdvanceTime, GetExperiment, UnknownOperation>;

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
/// Calls `visit` with each document and each list of bytes of the operation.
template <class AnyOperation, class Visit>
void for_each_document(AnyOperation& operation, const Visit& visit) {
  if constexpr (requires { operation.resource_string; }) visit(operation.resource_string);
  if constexpr (requires { operation.recorded; }) visit(operation.recorded);
  if constexpr (requires { operation.data; }) visit(operation.data);
}

}  // namespace cohort::wire
