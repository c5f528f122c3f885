#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

/// What <cohort/control.hpp> and <cohort/observer.hpp> have in common: poses and velocities, states of a simulation,
/// and what has happened in a run. Names follow ROS 2's simulation_interfaces and geometry_msgs where they have one.
/// Plain values in SI units; the world frame is right-handed with z up.
namespace cohort {

struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Vector3&) const = default;
};

/// A rotation of length 1, from the body's frame to the world's.
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

/// The velocity of the origin of an object's root link, along the axes of the world frame.
struct Twist {
  Vector3 linear{};   ///< [m/s]
  Vector3 angular{};  ///< [rad/s]
  bool operator==(const Twist&) const = default;
};

enum class SimulationState : std::uint32_t {
  stopped = 0,  ///< at the beginning, until it plays
  playing = 1,
  paused = 2,
  quitting = 3,  ///< run and server end
};

/// Something that happened in a run, perhaps more than once: a controller that joined or was late, an event of the
/// experiment, a request.
struct RunEvent {
  std::uint64_t tick = 0;       ///< of the first time
  std::uint64_t last_tick = 0;  ///< of the last time
  std::uint64_t count = 1;
  std::string kind;  ///< a word, for programs
  std::string text;  ///< for people
  bool operator==(const RunEvent&) const = default;
};

/// What has happened in a run, and how far back it can go.
struct RunHistory {
  std::uint32_t run = 0;              ///< its number; revisions begin at 0 with each run
  std::uint64_t revision = 0;         ///< to ask with next, for what happens after this
  std::uint64_t begin_tick = 0;       ///< that the run began or went on from
  std::uint64_t keep_interval = 0;    ///< ticks between kept snapshots; 0: the run cannot go back
  std::uint64_t first_kept_tick = 0;  ///< of the kept snapshots, if there are any
  std::uint64_t last_kept_tick = 0;
  std::vector<RunEvent> events;  ///< that happened or happened again, in the order of their last times
};

}  // namespace cohort
