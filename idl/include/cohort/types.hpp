// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

/// Types of <cohort/control.hpp> and <cohort/observer.hpp>: poses and velocities, states of a simulation, events of a
/// run, and files of an experiment. Names follow those in ROS 2's simulation_interfaces and geometry_msgs where these
/// define one. Values are in SI units; the world frame is right-handed with z up.
namespace cohort {

struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Vector3&) const = default;
};

/// A unit quaternion: the rotation from the body frame to the world frame.
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  bool operator==(const Quaternion&) const = default;
};

/// The pose of the origin of an object's root link in the world frame.
struct WorldPose {
  Vector3 position{};  ///< [m]
  Quaternion orientation{};
  bool operator==(const WorldPose&) const = default;
};

/// The velocity of the origin of an object's root link, expressed in the world frame.
struct Twist {
  Vector3 linear{};   ///< [m/s]
  Vector3 angular{};  ///< [rad/s]
  bool operator==(const Twist&) const = default;
};

enum class SimulationState : std::uint32_t {
  stopped = 0,  ///< at the start of the run, before the first tick
  playing = 1,
  paused = 2,
  quitting = 3,  ///< the run and the server are ending
};

/// An entry in a run's list of events: a controller that joined or was late, an event of the experiment, or a request.
/// An event that occurs repeatedly has one entry.
struct RunEvent {
  std::uint64_t tick = 0;       ///< tick of the first occurrence
  std::uint64_t last_tick = 0;  ///< tick of the last occurrence
  std::uint64_t count = 1;
  std::string kind;  ///< keyword, for programs
  std::string text;  ///< human-readable description
  bool operator==(const RunEvent&) const = default;
};

/// The events of a run, and the snapshots to which it can return.
struct RunHistory {
  std::uint32_t run = 0;              ///< number of the run; revisions start at 0 with each run
  std::uint64_t revision = 0;         ///< revision for the next query, which then returns only later events
  std::uint64_t begin_tick = 0;       ///< tick at which the run started or continued
  std::uint64_t keep_interval = 0;    ///< ticks between kept snapshots; 0: none are kept
  std::uint64_t first_kept_tick = 0;  ///< tick of the first kept snapshot, if there is one
  std::uint64_t last_kept_tick = 0;
  std::vector<RunEvent> events;  ///< events that are new or have occurred again, in the order of their last occurrences
};

struct ExperimentFile {
  std::string path;     ///< absolute, on the server's machine
  std::string content;  ///< may be binary
};

/// The files from which a run's experiment was read, and the settings that affect their reading.
struct ExperimentFiles {
  std::uint64_t seed = 0;                       ///< seed of the run
  std::chrono::nanoseconds duration{0};         ///< simulated duration of the experiment
  std::string experiment;                       ///< path of the experiment's file, as given to the server
  std::string working_folder;                   ///< absolute; base of relative paths
  std::string model_path;                       ///< COHORT_MODEL_PATH of the server
  std::vector<std::string> last_model_folders;  ///< the last folders in the search path of models
  std::vector<std::string> folders;             ///< folders that were searched and exist
  std::vector<ExperimentFile> files;            ///< in ascending order of paths
  std::vector<std::string> settings{};          ///< values that replace those of the files, as PATH=VALUE
};

}  // namespace cohort
