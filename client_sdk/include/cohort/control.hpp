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

/// Controls a run of a Cohort server: all that `cohort ctl` does, for programs. Such a program need not drive robots;
/// their controllers stay attached through resets and restores.
///
///     cohort::Control control({.domain = 7});
///     control.pause();
///     control.step(100);
///     std::printf("%f\n", control.entity_state("explorers/sbot_7").pose.position.x);
///     control.reset(2);  // from the beginning, with seed 2
///     control.play();
///
/// Entities are objects of the world under their scoped names, robots or not. Poses, twists, forces and torques are in
/// the world frame, in SI units. Names follow ROS 2's simulation_interfaces where it has one; each method says which
/// operation of docs/protocol.md, "Control", it is.
namespace cohort {

struct ControlOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain
  std::string secure{};              ///< folder of an identity (docs/security.md); empty: without security
  std::string label = "client";      ///< what the server calls this program; process and host are added
  /// How long each request waits. If empty: 30 s, and without end for `step`, `reset`, `stop`, `back` and
  /// `load_snapshot`, which take as long as controllers and new worlds do.
  std::optional<std::chrono::milliseconds> time_limit{};
};

/// Replaces what COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the domain is
/// not a number.
void take_environment(ControlOptions& options);

/// Why a request was not done. Up to `forgotten` it is the server's word.
enum class ControlResult {
  feature_unsupported,  ///< the server has no such operation, or not this of it
  not_found,            ///< there is no such object, light, link or data
  incorrect_state,      ///< not now, such as after the end of the run
  operation_failed,     ///< the message says why; the world is as it was
  name_not_unique,      ///< an object has this name
  name_invalid,
  no_resource,    ///< neither a model nor a text was given
  invalid_pose,   ///< of what is spawned
  malformed,      ///< a value is not finite or out of its range
  not_permitted,  ///< the identity may not do this
  forgotten,      ///< the request came too late
  no_answer,      ///< no reply within the time limit, or no server; what was asked for may still be done
  server_gone,    ///< a server was there, and is no longer
  interrupted,    ///< the flag of `stop_on` was set; what was asked for may still be done
  bad_reply,      ///< the server sent something else than it was asked for
  no_attachment,  ///< the server's address or the identity cannot be used
};

/// The only exception of this header, but for those of memory and files.
class ControlError : public std::runtime_error {
 public:
  explicit ControlError(const std::string& text, ControlResult why = ControlResult::operation_failed)
      : std::runtime_error(text), result(why) {}
  ControlResult result;
};

/// What the reply to every request says: the run as it was when the request had been done.
struct ControlReply {
  SimulationState state = SimulationState::stopped;
  std::uint32_t run = 0;             ///< 1 for the server's first, one higher after each reset or restore
  std::uint64_t tick = 0;            ///< the boundary at which it was done
  std::chrono::nanoseconds time{0};  ///< simulated, since tick 0
  std::string message;               ///< what was done, for people
};

struct SimulatorFeatures {
  std::vector<std::uint32_t> features;     ///< numbers of simulation_interfaces/msg/SimulatorFeatures
  std::vector<std::string> spawn_formats;  ///< of texts: `sdf`, `urdf`, `yaml`
};

/// An attached controller.
struct ControllerStatus {
  std::string label;         ///< controller, process and host, for people
  std::uint64_t client = 0;  ///< number of its attachment
  std::vector<std::uint32_t> robots;
  bool alive = false;
  bool awaited = false;                  ///< the run waits for it
  std::chrono::nanoseconds awaiting{0};  ///< for so long; wall time
  std::uint64_t due_tick = 0;            ///< of its oldest frame without an answer; of the next one if there is none
  std::uint64_t answers = 0;
  std::uint64_t late = 0;
  std::uint64_t rejected = 0;
  std::uint64_t resent = 0;                ///< frames that were sent again
  std::chrono::nanoseconds answer_p50{0};  ///< median time from the first sending of a frame to its answer
  std::chrono::nanoseconds answer_p99{0};  ///< and its 99th percentile
};

struct SimulationStatus {
  SimulationState state = SimulationState::stopped;
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated, since tick 0
  std::string experiment;
  std::uint64_t seed = 0;
  bool started = false;                  ///< false while controllers are missing at the start
  std::chrono::nanoseconds step{0};      ///< simulated time between ticks
  std::chrono::nanoseconds duration{0};  ///< simulated, of the whole run
  double speed = 0.0;                    ///< simulated seconds per second at the most; 0: as fast as it goes
  double real_time_factor = 0.0;         ///< simulated seconds per second, over the last half second or more
  std::uint64_t state_hash = 0;          ///< of the world's whole state at `tick`
  std::uint32_t robots = 0;
  std::uint32_t awaited_count = 0;      ///< robots that the run waits for
  std::vector<std::string> awaited;     ///< names of the first of them
  std::chrono::nanoseconds waiting{0};  ///< since the frames of this tick went out; wall time
  std::vector<ControllerStatus> controllers;
};

/// Pose and velocity of an entity's root link, in the world.
struct EntityState {
  std::string entity;
  WorldPose pose;
  Twist twist;
};

/// What is to be spawned, at rest: a model of the world, or one of a text. If both are given, the text counts.
struct Spawn {
  std::string name{};           ///< scoped, of the new entity
  bool allow_renaming = false;  ///< gives it another name if this one is taken
  std::string model{};          ///< name of a model that the world has, such as `sbot`
  std::string text{};           ///< of a model in SDF, URDF or YAML, at most 4 MiB
  WorldPose pose{};
  std::string team{};  ///< that a robot joins; empty: the only team, or the only one with robots of this model
};

struct Color {
  double red = 1.0, green = 1.0, blue = 1.0;  ///< 0 to 1
};

/// What a light is switched to.
struct LightSetting {
  bool on = true;
  std::optional<double> intensity{};  ///< >= 0 [1]; stays as it is if absent
  std::optional<Color> color{};       ///< likewise
};

/// At a link's centre of mass, in the world's axes, from this boundary on.
struct AppliedForce {
  Vector3 force{};                       ///< [N]
  Vector3 torque{};                      ///< [N m]
  std::chrono::nanoseconds duration{0};  ///< simulated; at least one step
  std::string link{};                    ///< empty: the root link
};

enum class ResetScope : std::uint32_t { all = 0, time = 1, state = 2, spawned = 4 };

/// A piece of a recording's file.
struct RecordingPart {
  std::vector<std::byte> bytes;  ///< maybe none yet
  bool is_last = false;
  std::string problem;  ///< with the last one: why the file holds less than was asked for; else empty
};

/// A connection to the run of one server. All methods are for one thread at a time; only the flag of `stop_on` may be
/// set elsewhere. Each method blocks until its reply is there, for at most the time limit, which also covers waiting
/// for a server; a request that gets lost is sent again and done once. Queries are answered at once. Everything else
/// is done at the next boundary between two ticks, so it waits while the run waits for a controller. Every method
/// throws ControlError if it was not done.
class Control {
 public:
  /// Returns at once: the first request waits for a server that is not there yet. Throws ControlError
  /// (`no_attachment`) if the address or the identity cannot be used.
  explicit Control(const ControlOptions& options);
  /// The server forgets what it kept for this program: snapshots that were saved, and a recording.
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  /// Ends each wait with ControlError (`interrupted`) while `stop` is set, within some 10 ms; `stop_on_signals` of
  /// <cohort/client.hpp> gives such a flag. It must outlive this object or the next call. nullptr: no flag.
  void stop_on(const std::atomic<bool>* stop);
  /// As ControlOptions::time_limit, from now on.
  void set_time_limit(std::optional<std::chrono::milliseconds> time_limit);
  /// Waits until a server is there, instead of for the time limit for at most `at_most`; returns whether one is.
  /// Returns false also if the flag of `stop_on` is set. Does not throw.
  bool wait_for_server(std::chrono::milliseconds at_most);
  /// Returns whether a server was there, and has been gone for more than 2 s.
  bool server_is_gone() const;
  /// What the reply to the last request said that was done; valid until the next request.
  const ControlReply& last_reply() const;

  // Time.

  /// Returns what the server can do (GetSimulatorFeatures).
  SimulatorFeatures features();
  SimulationState state();    ///< GetSimulationState
  SimulationStatus status();  ///< GetStatus: how the run is, and who is awaited
  /// Lets the run go on, or does nothing if it plays (SetSimulationState).
  ControlReply play();
  /// Holds the run at the next boundary, or does nothing if it is paused (SetSimulationState).
  ControlReply pause();
  /// Begins another run from the beginning, paused (SetSimulationState).
  ControlReply stop();
  /// Ends the run and the server (SetSimulationState). A server that has gone before its reply came counts as done.
  ControlReply quit();
  /// Makes `steps` ticks of a paused run, and returns when it is paused again (StepSimulation). `steps`: 1 to 2^62.
  ControlReply step(std::uint64_t steps = 1);
  /// Begins another run from the beginning, with `seed` or the same one (ResetSimulation). A paused run stays paused.
  /// Servers of this version reset all or nothing: another scope is `feature_unsupported`.
  ControlReply reset(std::optional<std::uint64_t> seed = {}, ResetScope scope = ResetScope::all);
  /// Goes on from the last snapshot that the server kept at or before a simulated time (GoBack).
  ControlReply back(std::chrono::nanoseconds time);
  /// Sets simulated seconds per second at the most, 0 for as fast as it goes (SetSpeed).
  ControlReply set_speed(double speed);

  // The world.

  /// Returns the names of all entities, a part of which matches `filter`: a POSIX extended regular expression of at
  /// most 200 characters; all if it is empty (GetEntities).
  std::vector<std::string> entities(const std::string& filter = "");
  EntityState entity_state(const std::string& entity);  ///< GetEntityState
  /// Puts an entity elsewhere, at rest (SetEntityState).
  ControlReply set_pose(const std::string& entity, const WorldPose& pose);
  /// Gives an entity a velocity (SetEntityState).
  ControlReply set_twist(const std::string& entity, const Twist& twist);
  /// Does both at one boundary (SetEntityState).
  ControlReply set_entity_state(const EntityState& state);
  /// Returns the name that the new entity got (SpawnEntity).
  std::string spawn(const Spawn& what);
  ControlReply remove(const std::string& entity);  ///< DeleteEntity
  /// `light`: `object/light`, an object for all of its lights, or a light of the world (SetLight).
  ControlReply set_light(const std::string& light, const LightSetting& setting);
  ControlReply apply_force(const std::string& entity, const AppliedForce& force);  ///< ApplyForce

  // Snapshots, at most 256 MiB each.

  /// Returns the run as it stands at the next boundary, with the state of its controllers (SaveSnapshot, GetData).
  /// `last_reply().message` names the teams whose state is not in it. The time limit counts for each of its parts.
  std::vector<std::byte> save_snapshot();
  /// Goes on from a snapshot, as another run (PutData, LoadSnapshot). The time limit counts for each of its parts.
  ControlReply load_snapshot(std::span<const std::byte> snapshot);

  // A recording (MCAP), one at a time. The server keeps at most 80 MiB that was not fetched.

  /// Begins a recording at the next boundary (StartRecording). `recorded`: what it holds, in YAML as after an
  /// experiment's `record`, such as `{poses: 25}`; empty: what the experiment says.
  ControlReply start_recording(const std::string& recorded = "");
  /// Ends the recording here; the rest of its file is still to be fetched (StopRecording).
  ControlReply stop_recording();
  /// Returns what there is of the file from byte `offset` on, up to 256 KiB. The server forgets all bytes before it
  /// (GetRecording). While it returns no bytes, ask again after some 50 ms.
  RecordingPart fetch_recording(std::uint64_t offset);
  /// Fetches the whole file from its beginning on and writes it to `file`, until the recording has ended because of
  /// `stop_recording` or because the run has ended. Returns why it holds less than was asked for; empty if it does
  /// not. Blocks as long as the recording goes on; the time limit counts for each part. Throws std::runtime_error if
  /// the file cannot be written. What was written before a failure stays; `cohort recover` mends it.
  std::string save_recording(const std::filesystem::path& file);

  /// Returns what has happened since a revision, 0 for all, and how far back the run can go (GetHistory). An event that
  /// happened again comes again, with its new count.
  RunHistory history(std::uint64_t since = 0);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
