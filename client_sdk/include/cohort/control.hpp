// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cohort/types.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// Functions that control a run of a Cohort server, for programs that do what `cohort ctl` does. Such a program need
/// not drive robots. Controllers stay attached when the run is reset or restored.
///
///     cohort::Control control({.domain = 7});
///     control.pause();
///     control.step(100);
///     std::printf("%f\n", control.entity_state("explorers/sbot_7").pose.position.x);
///     control.reset(2);  // from the beginning, with seed 2
///     control.play();
/// Entities are the objects of the world, including robots, and are identified by their scoped names. Poses, twists,
/// forces and torques are in the world frame, in SI units. Names follow those in ROS 2's simulation_interfaces where it
/// defines one. The comment of each method names its operation in docs/protocol.md, "Control". A boundary is the moment
/// between two ticks.
namespace cohort {

struct ControlOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain
  std::string secure{};              ///< folder of this client's identity (docs/security.md); no security if empty
  std::string label = "client";      ///< name that the server shows for this program, with process id and host
  /// Time limit of each request. If empty: 30 s, and no limit for `step`, `advance_time`, `reset`, `stop`, `back` and
  /// `load_snapshot`, because these wait for controllers or build a world.
  std::optional<std::chrono::milliseconds> time_limit{};
};

/// Sets `server`, `domain` and `secure` from COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE, if those are set. Throws
/// std::invalid_argument if the domain is not a number.
void take_environment(ControlOptions& options);

/// The reason why a request failed. The client sets the values from `no_answer` to `no_attachment`; the server sends
/// the others. Servers of 0.2 and before send `operation_failed` instead of those after `no_attachment`.
enum class ControlResult {
  feature_unsupported,  ///< the server does not support this operation, or an option of it
  not_found,            ///< no such object or data
  incorrect_state,      ///< not possible now, such as after the end of the run
  operation_failed,     ///< none of the other reasons; the message gives it. The world is unchanged
  name_not_unique,      ///< another object has this name
  name_invalid,
  no_resource,          ///< neither the name nor the text of a model was given
  invalid_pose,         ///< the pose of a new object is invalid
  malformed,            ///< a value is not finite or out of range
  not_permitted,        ///< the client's identity does not have this right
  forgotten,            ///< the request came too late
  no_answer,            ///< no reply within the time limit, or no server; the request may still be executed
  server_gone,          ///< the server has crashed or exited
  interrupted,          ///< the flag of `stop_on` was set; the request may still be executed
  bad_reply,            ///< the server's reply does not match the request
  no_attachment,        ///< the server's address or the identity cannot be used
  too_many_requests,    ///< too many requests of this client or its identity wait
  cancelled,            ///< a change of state or the end of the run cancelled the remaining steps
  not_paused,           ///< a run that plays cannot be stepped
  time_not_held,        ///< this client does not hold the run's time
  link_not_found,       ///< the object has no such link
  light_not_found,      ///< no such light, or its object is not in the world
  immovable,            ///< the object is static, or fixed to the world
  quarantined,          ///< the object has left the world, or its state is no longer finite
  unknown_model,        ///< the world has no model of this name
  invalid_model,        ///< the text of the model cannot be read
  missing_file,         ///< the text of the model refers to a file that the server's world does not have
  unsupported_model,    ///< the physics of this run cannot simulate the model, or not at this pose
  invalid_team,         ///< no such team, or the robot needs the name of one, or the model is not a robot
  too_many_objects,     ///< no more objects can be added in this run
  too_large,            ///< the data exceed what can be sent
  invalid_snapshot,     ///< the snapshot is damaged, or of another experiment or version
  not_saved,            ///< the state of the run or of a controller cannot be saved
  already_recording,    ///< this client has a recording
  too_many_recordings,  ///< the run has as many live recordings as it can have
  invalid_selection,    ///< the selection of the recording's contents cannot be read
};

/// The exception that a request failed. The functions of this header throw no other, except for memory and file errors.
class ControlError : public std::runtime_error {
 public:
  explicit ControlError(const std::string& text, ControlResult why = ControlResult::operation_failed)
      : std::runtime_error(text), result(why) {}
  ControlResult result;
};

/// The reply to a request: the state of the run after the request was executed.
struct ControlReply {
  SimulationState state = SimulationState::stopped;
  std::uint32_t run = 0;             ///< 1 for the server's first run; increases after each reset or restore
  std::uint64_t tick = 0;            ///< tick boundary at which the request was executed
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::string message;               ///< human-readable description of the result
  bool was_in_state = false;  ///< true if the run was already in the state that `play`, `pause` or `stop` requests
};

struct SimulatorFeatures {
  std::vector<std::uint32_t> features;     ///< numbers of simulation_interfaces/msg/SimulatorFeatures
  std::vector<std::string> spawn_formats;  ///< formats of model texts: `sdf`, `urdf`, `yaml`
};

/// An attached controller.
struct ControllerStatus {
  std::string label;         ///< human-readable: controller, process and host
  std::uint64_t client = 0;  ///< number of its attachment
  std::vector<std::uint32_t> robots;
  bool alive = false;
  bool awaited = false;                  ///< true if the run waits for it
  std::chrono::nanoseconds awaiting{0};  ///< wall time for which the run has waited for it
  std::uint64_t due_tick = 0;            ///< tick of its oldest unanswered frame, or else of the next frame
  std::uint64_t answers = 0;
  std::uint64_t late = 0;
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;                ///< number of frames that were sent again
  std::chrono::nanoseconds answer_p50{0};  ///< median time from the first transmission of a frame to its answer
  std::chrono::nanoseconds answer_p99{0};  ///< 99th percentile of this time
};

struct SimulationStatus {
  SimulationState state = SimulationState::stopped;
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::string experiment;
  std::uint64_t seed = 0;
  bool started = false;                  ///< false while controllers are missing at the start
  std::chrono::nanoseconds step{0};      ///< simulated time between ticks
  std::chrono::nanoseconds duration{0};  ///< total simulated duration of the run
  double speed = 0.0;                    ///< limit of the real-time factor; 0: no limit
  double real_time_factor = 0.0;         ///< simulated seconds per wall-clock second, over the last half second or more
  std::uint64_t state_hash = 0;          ///< hash of the whole world at `tick`
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;      ///< number of robots that the run waits for
  std::vector<std::string> awaited;     ///< names of the first few of these robots
  std::chrono::nanoseconds waiting{0};  ///< wall time since the frames of this tick were sent
  std::vector<ControllerStatus> controllers;
};

/// Pose and velocity of an entity's root link, in the world frame.
struct EntityState {
  std::string entity;
  WorldPose pose;
  Twist twist;
};

/// An entity to spawn, at rest. Its model is one in the world, or is given as text. If both are given, the text is
/// used.
struct Spawn {
  std::string name{};           ///< scoped name of the new entity
  bool allow_renaming = false;  ///< true: the server chooses another name if `name` is taken
  std::string model{};          ///< name of a model in the world, such as `sbot`
  std::string text{};           ///< model in SDF, URDF or YAML, at most 4 MiB
  WorldPose pose{};
  std::string team{};  ///< team that a robot joins; if empty, the only team, or the only team with robots of this model
};

struct Color {
  double red = 1.0, green = 1.0, blue = 1.0;  ///< from 0 to 1
};

/// New settings of a light.
struct LightSetting {
  bool on = true;
  std::optional<double> intensity{};  ///< >= 0 [1]; unchanged if absent
  std::optional<Color> color{};       ///< unchanged if absent
};

/// A force and a torque at a link's centre of mass, expressed in the world frame, which act from the next boundary on.
struct AppliedForce {
  Vector3 force{};                       ///< [N]
  Vector3 torque{};                      ///< [N m]
  std::chrono::nanoseconds duration{0};  ///< duration in simulated time; at least one step
  std::string link{};                    ///< name of the link; the root link if empty
};

enum class ResetScope : std::uint32_t { all = 0, time = 1, state = 2, spawned = 4 };

/// A part of a recording file.
struct RecordingPart {
  std::vector<std::byte> bytes;  ///< may be empty
  bool is_last = false;
  std::string problem;  ///< in the last part: reason why the file contains less than requested; otherwise empty
};

/// A connection to the run of one server. Call its methods from one thread at a time; only the flag of `stop_on` may be
/// set from other threads. Each method blocks until its reply arrives, at most for the time limit, which includes the
/// time until a server is found. A lost request is sent again, but executed only once. The server answers queries
/// immediately. It executes all other requests at the next boundary, so they wait while the run waits for a controller.
/// Every method throws ControlError if its request fails.
class Control {
 public:
  /// Connects to the server. Does not block; the first request waits until there is a server. Throws ControlError
  /// (`no_attachment`) if the address or the identity cannot be used.
  explicit Control(const ControlOptions& options);
  /// Disconnects. The server discards this program's saved snapshots and recording.
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  /// Sets a flag that interrupts requests: while `stop` is true, each request ends with ControlError (`interrupted`)
  /// within about 10 ms. `stop_on_signals` in <cohort/client.hpp> returns such a flag. The flag must exist until this
  /// object is destroyed or another flag is set. nullptr: no flag.
  void stop_on(const std::atomic<bool>* stop);
  /// Sets ControlOptions::time_limit for later requests.
  void set_time_limit(std::optional<std::chrono::milliseconds> time_limit);
  /// Waits for a server for up to `at_most`, regardless of the time limit. Returns true if a server was found, and
  /// false after that time or if the flag of `stop_on` is set. Does not throw.
  bool wait_for_server(std::chrono::milliseconds at_most);
  /// Returns true if the server has been unreachable for more than 2 s. Returns false if no server has been found yet.
  bool server_is_gone() const;
  /// Returns the reply to the last successful request; valid until the next request.
  const ControlReply& last_reply() const;

  // Time

  /// Returns the capabilities of the server (GetSimulatorFeatures).
  SimulatorFeatures features();
  SimulationState state();    ///< GetSimulationState
  SimulationStatus status();  ///< GetStatus: the state of the run and the robots that it waits for
  /// Resumes the run; does nothing if it is already playing (SetSimulationState).
  ControlReply play();
  /// Pauses the run at the next boundary; does nothing if it is already paused (SetSimulationState).
  ControlReply pause();
  /// Restarts the run from the beginning, paused (SetSimulationState).
  ControlReply stop();
  /// Ends the run and the server (SetSimulationState). Succeeds even if the server exits before its reply arrives.
  ControlReply quit();
  /// Advances a paused run by `steps` ticks, and returns when it is paused again (StepSimulation). `steps`: 1 to 2^62.
  ControlReply step(std::uint64_t steps = 1);
  /// Puts the run's time under the control of this program, from the next frames on, until `release_time` or the
  /// destruction of this object (AdvanceTime). The run proceeds from a tick only when every program that controls its
  /// time has requested a later tick. This keeps a program with its own clock in lockstep with the run, even if it does
  /// not drive robots.
  ControlReply hold_time();
  /// Requests the tick that is `steps` ticks after the last tick that this function returned (AdvanceTime). Returns
  /// when the run has reached that tick and has sent its frames, to which controllers then compute their answers. The
  /// first call after `hold_time` or a reset returns at the current tick. `steps`: 1 to 2^62.
  ControlReply advance_time(std::uint64_t steps = 1);
  ControlReply release_time();  ///< ends `hold_time` (AdvanceTime)
  /// Restarts the run from the beginning, with `seed` or with the same seed (ResetSimulation). A paused run stays
  /// paused. Servers of this version support only ResetScope::all; other scopes fail with `feature_unsupported`.
  ControlReply reset(std::optional<std::uint64_t> seed = {}, ResetScope scope = ResetScope::all);
  /// Returns the run to the last kept snapshot at or before a simulated time, and continues from there (GoBack).
  ControlReply back(std::chrono::nanoseconds time);
  /// Limits the real-time factor, the simulated seconds per wall-clock second; 0: no limit (SetSpeed).
  ControlReply set_speed(double speed);

  // World

  /// Returns the names of the entities whose name contains a match of `filter`, a POSIX extended regular expression of
  /// at most 200 characters. Returns all names if `filter` is empty (GetEntities).
  std::vector<std::string> entities(const std::string& filter = "");
  EntityState entity_state(const std::string& entity);  ///< GetEntityState
  /// Moves an entity to a pose and stops it (SetEntityState).
  ControlReply set_pose(const std::string& entity, const WorldPose& pose);
  /// Sets the velocity of an entity (SetEntityState).
  ControlReply set_twist(const std::string& entity, const Twist& twist);
  /// Sets the pose and the velocity of an entity at one boundary (SetEntityState).
  ControlReply set_entity_state(const EntityState& state);
  /// Adds an entity and returns its name (SpawnEntity).
  std::string spawn(const Spawn& what);
  ControlReply remove(const std::string& entity);  ///< DeleteEntity
  /// Switches lights on or off and sets their properties (SetLight). `light` is `object/light`, the name of an object
  /// (all of its lights), or a light of the world.
  ControlReply set_light(const std::string& light, const LightSetting& setting);
  ControlReply apply_force(const std::string& entity, const AppliedForce& force);  ///< ApplyForce

  // Snapshots, at most 256 MiB each

  /// Returns a snapshot of the run at the next boundary, including the state of its controllers (SaveSnapshot,
  /// GetData). `last_reply().message` names the teams whose controllers did not save their state. The snapshot is
  /// transferred in parts; the time limit applies to each part.
  std::vector<std::byte> save_snapshot();
  /// Continues from a snapshot, as a new run (PutData, LoadSnapshot). The time limit applies to each part.
  ControlReply load_snapshot(std::span<const std::byte> snapshot);

  // Recordings (MCAP), one at a time. The server keeps at most 80 MiB of unfetched data.

  /// Starts a recording at the next boundary (StartRecording). `recorded` defines its contents in YAML, like an
  /// experiment's key `record`, for example `{poses: 25}`. If it is empty, the experiment's key `record` applies.
  ControlReply start_recording(const std::string& recorded = "");
  /// Ends the recording; the rest of its file can still be fetched (StopRecording).
  ControlReply stop_recording();
  /// Returns up to 256 KiB of the recording file, starting at byte `offset`. The server discards all earlier bytes
  /// (GetRecording). If the result contains no bytes, call the method again after about 50 ms.
  RecordingPart fetch_recording(std::uint64_t offset);
  /// Fetches the whole recording and writes it to `file`. Blocks until `stop_recording` or the end of the run ends the
  /// recording; the time limit applies to each part. Returns the reason if the file contains less than requested;
  /// otherwise an empty string. Throws std::runtime_error if the file cannot be written. A partial file remains after a
  /// failure; `cohort recover` repairs it.
  std::string save_recording(const std::filesystem::path& file);

  /// Returns the events since a revision, 0 for all events, and the range of the kept snapshots (GetHistory). An event
  /// that has occurred again is returned again, with its new count.
  RunHistory history(std::uint64_t since = 0);
  /// Returns the files from which the run's experiment was read (GetExperiment). They are transferred in parts; the
  /// time limit applies to each part. Fails with `not_found` if a program created the experiment without files.
  ExperimentFiles experiment_files();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
