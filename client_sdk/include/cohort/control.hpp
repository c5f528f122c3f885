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

/// Controls a run of a Cohort server: everything that `cohort ctl` does, for programs. Such a program need not drive
/// robots; their controllers stay attached through resets and restores.
///
///     cohort::Control control({.domain = 7});
///     control.pause();
///     control.step(100);
///     std::printf("%f\n", control.entity_state("explorers/sbot_7").pose.position.x);
///     control.reset(2);  // from the beginning, with seed 2
///     control.play();
///
/// Entities are the objects of the world, robots included, under their scoped names. Poses, twists, forces and torques
/// are in the world frame, in SI units. Names follow ROS 2's simulation_interfaces where it has one. Each method names
/// its operation in docs/protocol.md, "Control". A boundary is the moment between two ticks.
namespace cohort {

struct ControlOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain
  std::string secure{};              ///< folder of an identity (docs/security.md); no security if empty
  std::string label = "client";      ///< name of this program at the server; process and host are added
  /// Time limit of each request. If empty: 30 s, and no limit for `step`, `reset`, `stop`, `back` and `load_snapshot`,
  /// whose duration depends on controllers and new worlds.
  std::optional<std::chrono::milliseconds> time_limit{};
};

/// Replaces the options that COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the
/// domain is not a number.
void take_environment(ControlOptions& options);

/// The reason why a request failed. The server sends those up to `forgotten`.
enum class ControlResult {
  feature_unsupported,  ///< the server does not have this operation, or this option of it
  not_found,            ///< no such object, light, link or data
  incorrect_state,      ///< not possible now, such as after the end of the run
  operation_failed,     ///< the message gives the reason; the world is unchanged
  name_not_unique,      ///< another object has this name
  name_invalid,
  no_resource,    ///< neither a model nor a text was given
  invalid_pose,   ///< the pose of a new object is invalid
  malformed,      ///< a value is not finite or out of range
  not_permitted,  ///< the identity does not have the right
  forgotten,      ///< the request came too late
  no_answer,      ///< no reply within the time limit, or no server; the request may still be done
  server_gone,    ///< the server is no longer there
  interrupted,    ///< the flag of `stop_on` was set; the request may still be done
  bad_reply,      ///< the server's reply does not match the request
  no_attachment,  ///< the server's address or the identity cannot be used
};

/// The only exception of this header, except those of memory and files.
class ControlError : public std::runtime_error {
 public:
  explicit ControlError(const std::string& text, ControlResult why = ControlResult::operation_failed)
      : std::runtime_error(text), result(why) {}
  ControlResult result;
};

/// The reply to a request: the state of the run once the request was done.
struct ControlReply {
  SimulationState state = SimulationState::stopped;
  std::uint32_t run = 0;             ///< 1 for the server's first run; increases after each reset or restore
  std::uint64_t tick = 0;            ///< boundary at which the request was done
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::string message;               ///< description of what was done, for people
};

struct SimulatorFeatures {
  std::vector<std::uint32_t> features;     ///< numbers of simulation_interfaces/msg/SimulatorFeatures
  std::vector<std::string> spawn_formats;  ///< formats of model texts: `sdf`, `urdf`, `yaml`
};

/// An attached controller.
struct ControllerStatus {
  std::string label;         ///< controller, process and host, for people
  std::uint64_t client = 0;  ///< number of its attachment
  std::vector<std::uint32_t> robots;
  bool alive = false;
  bool awaited = false;                  ///< true if the run waits for it
  std::chrono::nanoseconds awaiting{0};  ///< how long the run has waited for it; wall time
  std::uint64_t due_tick = 0;            ///< tick of its oldest unanswered frame; of the next frame if all are answered
  std::uint64_t answers = 0;
  std::uint64_t late = 0;
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;                ///< number of frames that were sent again
  std::chrono::nanoseconds answer_p50{0};  ///< median time from the first sending of a frame to its answer
  std::chrono::nanoseconds answer_p99{0};  ///< 99th percentile of the same time
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
  std::chrono::nanoseconds duration{0};  ///< simulated duration of the whole run
  double speed = 0.0;                    ///< limit of the real-time factor; 0: no limit
  double real_time_factor = 0.0;         ///< simulated seconds per wall-clock second, over the last half second or more
  std::uint64_t state_hash = 0;          ///< hash of the whole world at `tick`
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;      ///< number of robots that the run waits for
  std::vector<std::string> awaited;     ///< names of the first of them
  std::chrono::nanoseconds waiting{0};  ///< time since the frames of this tick were sent; wall time
  std::vector<ControllerStatus> controllers;
};

/// Pose and velocity of an entity's root link, in the world frame.
struct EntityState {
  std::string entity;
  WorldPose pose;
  Twist twist;
};

/// An entity to spawn, at rest: a model of the world, or a model as text. If both are given, the text is used.
struct Spawn {
  std::string name{};           ///< scoped name of the new entity
  bool allow_renaming = false;  ///< chooses another name if this one is taken
  std::string model{};          ///< name of a model in the world, such as `sbot`
  std::string text{};           ///< model in SDF, URDF or YAML, at most 4 MiB
  WorldPose pose{};
  std::string team{};  ///< team that a robot joins; if empty, the only team, or the only one with robots of this model
};

struct Color {
  double red = 1.0, green = 1.0, blue = 1.0;  ///< 0 to 1
};

/// New settings of a light.
struct LightSetting {
  bool on = true;
  std::optional<double> intensity{};  ///< >= 0 [1]; unchanged if absent
  std::optional<Color> color{};       ///< unchanged if absent
};

/// A force and a torque at a link's centre of mass, in the world frame, applied from the next boundary on.
struct AppliedForce {
  Vector3 force{};                       ///< [N]
  Vector3 torque{};                      ///< [N m]
  std::chrono::nanoseconds duration{0};  ///< simulated time; at least one step
  std::string link{};                    ///< root link if empty
};

enum class ResetScope : std::uint32_t { all = 0, time = 1, state = 2, spawned = 4 };

/// A piece of a recording's file.
struct RecordingPart {
  std::vector<std::byte> bytes;  ///< may be empty
  bool is_last = false;
  std::string problem;  ///< in the last part: why the file contains less than requested; otherwise empty
};

/// A connection to the run of one server. Call its methods from one thread at a time; only the flag of `stop_on` may be
/// set from elsewhere. Each method blocks until its reply arrives, at most for the time limit, which includes the wait
/// for a server. A lost request is sent again and done once. Queries are answered at once. All other requests are done
/// at the next boundary, so they wait while the run waits for a controller. Every method throws ControlError if its
/// request fails.
class Control {
 public:
  /// Returns at once; the first request waits for a server that is not there yet. Throws ControlError (`no_attachment`)
  /// if the address or the identity cannot be used.
  explicit Control(const ControlOptions& options);
  /// Disconnects. The server discards what it kept for this program: saved snapshots, and a recording.
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  /// Ends each wait with ControlError (`interrupted`) while `stop` is set, within about 10 ms. `stop_on_signals` of
  /// <cohort/client.hpp> returns such a flag. The flag must outlive this object or the next call. nullptr: no flag.
  void stop_on(const std::atomic<bool>* stop);
  /// Sets ControlOptions::time_limit for later requests.
  void set_time_limit(std::optional<std::chrono::milliseconds> time_limit);
  /// Waits for a server, at most `at_most` instead of the time limit, and returns true if one is there. Returns false
  /// also if the flag of `stop_on` is set. Does not throw.
  bool wait_for_server(std::chrono::milliseconds at_most);
  /// Returns true if the server has been gone for more than 2 s. Returns false if there has been none yet.
  bool server_is_gone() const;
  /// Returns the reply to the last successful request; valid until the next request.
  const ControlReply& last_reply() const;

  // Time

  /// Returns the capabilities of the server (GetSimulatorFeatures).
  SimulatorFeatures features();
  SimulationState state();    ///< GetSimulationState
  SimulationStatus status();  ///< GetStatus: the state of the run, and which robots it waits for
  /// Resumes the run; does nothing if it is playing (SetSimulationState).
  ControlReply play();
  /// Pauses the run at the next boundary; does nothing if it is paused (SetSimulationState).
  ControlReply pause();
  /// Restarts the run from the beginning, paused (SetSimulationState).
  ControlReply stop();
  /// Ends the run and the server (SetSimulationState). Succeeds also if the server exits before its reply arrives.
  ControlReply quit();
  /// Advances a paused run by `steps` ticks, and returns when it is paused again (StepSimulation). `steps`: 1 to 2^62.
  ControlReply step(std::uint64_t steps = 1);
  /// Holds the run's time for this program, from the next frames on, until `release_time` or the destruction of this
  /// object (AdvanceTime). The run leaves a tick only when every program that holds its time has requested a later one.
  /// This keeps a program with its own clock in lockstep, whether or not it drives robots.
  ControlReply hold_time();
  /// Requests the tick that is `steps` ticks after the last one that this function returned. Returns when the run is at
  /// that tick and its frames have been sent; controllers then compute their answers (AdvanceTime). The first call
  /// after `hold_time`, or in another run after a reset, returns at the current tick. `steps`: 1 to 2^62.
  ControlReply advance_time(std::uint64_t steps = 1);
  ControlReply release_time();  ///< AdvanceTime
  /// Restarts the run from the beginning, with `seed` or the same one (ResetSimulation). A paused run stays paused.
  /// Servers of this version reset everything or nothing: another scope is `feature_unsupported`.
  ControlReply reset(std::optional<std::uint64_t> seed = {}, ResetScope scope = ResetScope::all);
  /// Continues from the last snapshot that the server kept at or before a simulated time (GoBack).
  ControlReply back(std::chrono::nanoseconds time);
  /// Limits the real-time factor, the simulated seconds per wall-clock second; 0: no limit (SetSpeed).
  ControlReply set_speed(double speed);

  // World

  /// Returns the names of the entities that contain a match of `filter`, a POSIX extended regular expression of at most
  /// 200 characters. Returns all names if it is empty (GetEntities).
  std::vector<std::string> entities(const std::string& filter = "");
  EntityState entity_state(const std::string& entity);  ///< GetEntityState
  /// Moves an entity to a pose, at rest (SetEntityState).
  ControlReply set_pose(const std::string& entity, const WorldPose& pose);
  /// Sets the velocity of an entity (SetEntityState).
  ControlReply set_twist(const std::string& entity, const Twist& twist);
  /// Sets the pose and the velocity of an entity at one boundary (SetEntityState).
  ControlReply set_entity_state(const EntityState& state);
  /// Adds an entity and returns its name (SpawnEntity).
  std::string spawn(const Spawn& what);
  ControlReply remove(const std::string& entity);  ///< DeleteEntity
  /// Switches a light (SetLight). `light` is `object/light`, an object for all of its lights, or a light of the world.
  ControlReply set_light(const std::string& light, const LightSetting& setting);
  ControlReply apply_force(const std::string& entity, const AppliedForce& force);  ///< ApplyForce

  // Snapshots, at most 256 MiB each

  /// Returns a snapshot of the run at the next boundary, with the state of its controllers (SaveSnapshot, GetData).
  /// `last_reply().message` names the teams whose state is missing. The time limit applies to each part.
  std::vector<std::byte> save_snapshot();
  /// Continues from a snapshot, as another run (PutData, LoadSnapshot). The time limit applies to each part.
  ControlReply load_snapshot(std::span<const std::byte> snapshot);

  // Recordings (MCAP), one at a time. The server keeps at most 80 MiB of unfetched data.

  /// Starts a recording at the next boundary (StartRecording). `recorded` is its content in YAML, as in an experiment's
  /// `record`, such as `{poses: 25}`; if empty, that of the experiment.
  ControlReply start_recording(const std::string& recorded = "");
  /// Ends the recording; the rest of its file can still be fetched (StopRecording).
  ControlReply stop_recording();
  /// Returns up to 256 KiB of the file from byte `offset` on. The server discards all earlier bytes (GetRecording). If
  /// it returns no bytes, call it again after about 50 ms.
  RecordingPart fetch_recording(std::uint64_t offset);
  /// Fetches the whole file and writes it to `file`, until `stop_recording` or the end of the run ends the recording.
  /// Returns why it contains less than requested, or an empty text. Blocks while the recording continues; the time
  /// limit applies to each part. Throws std::runtime_error if the file cannot be written. A partial file remains after
  /// a failure; `cohort recover` repairs it.
  std::string save_recording(const std::filesystem::path& file);

  /// Returns the events since a revision, 0 for all, and how far back the run can go (GetHistory). A repeated event is
  /// returned again, with its new count.
  RunHistory history(std::uint64_t since = 0);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
