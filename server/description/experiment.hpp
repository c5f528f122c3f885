// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/description/event.hpp"
#include "server/description/kept_files.hpp"
#include "server/description/parsed_model.hpp"
#include "server/description/ros2.hpp"
#include "server/description/world.hpp"

namespace cohort::description {

/// Response to a late answer of a controller (docs/semantics.md).
enum class OnLate { wait, hold, zero, detach, stop };

/// Returns the value as it is written in experiments.
inline const char* word_of(OnLate on_late) {
  switch (on_late) {
    case OnLate::wait: return "wait";
    case OnLate::hold: return "hold";
    case OnLate::zero: return "zero";
    case OnLate::detach: return "detach";
    case OnLate::stop: return "stop";
  }
  return "unknown";
}

enum class Mode {
  lockstep,  ///< the world waits for each answer, as defined by `on_late`
  free,      ///< the world never waits; the newest answer acts from the tick after its arrival
};

/// Response when a new process takes over a robot whose controller is lost.
enum class OnLost {
  go_on,   ///< the run continues with a new controller without state
  rewind,  ///< the run returns to its last snapshot, for which the state of controllers is known
};

/// When observations go to the controller of a robot, and the response to a late answer (docs/semantics.md).
struct Policy {
  std::uint32_t period = 1;  ///< observations every `period` ticks, >= 1
  std::uint32_t phase = 0;   ///< tick of the first observation, < period
  std::uint32_t delay = 0;   ///< the answer to frame k acts at tick k + delay
  OnLate on_late = OnLate::wait;
  /// Wall time to wait for an answer, for each tick; in `free` mode, since the last answer, and 0 means without limit.
  /// Not used under `wait`.
  std::chrono::nanoseconds deadline{0};
  Mode mode = Mode::lockstep;
  bool required = true;  ///< the run neither starts nor continues without a controller
  OnLost on_lost = OnLost::go_on;
};

/// Response to the exit of a controller process.
enum class Restart { on_failure, never };

/// A parameter for the controllers of a team. Nested maps are flattened: their keys are joined by '.'.
struct Parameter {
  std::string name;
  std::vector<std::string> values;  ///< one value, or those of a list, as written
  int line = 0;                     ///< in the file of the experiment
};

/// Robots that share a controller and a policy.
struct Team {
  std::string name;
  std::vector<std::uint32_t> robots;  ///< ids, ascending
  std::string controller;             ///< name of a plugin, or path to one; empty for none
  Policy policy;
  Restart restart = Restart::on_failure;
  std::vector<Parameter> parameters{};  ///< in the order of the file
  int controller_line = 0;              ///< line of the key `controller` in the file
};

struct Experiment {
  std::filesystem::path file;
  std::string name;  ///< name of the file, without the extension
  World world;
  std::uint64_t seed = 1;
  std::chrono::nanoseconds duration{0};
  std::vector<Team> teams;    ///< every robot is in exactly one
  unsigned threads = 0;       ///< number of threads that step the world; 0 for the number of cores
  std::vector<Event> events;  ///< ordered by time, then as in the file
  std::vector<Reaction> reactions;
  std::vector<Spawner> spawners{};
  std::vector<StopCondition> stops;
  std::vector<PrintedQuantity> prints;
  History history;
  Recorded recorded;
  Ros2 ros2{};
  std::shared_ptr<const KeptFiles> inputs{};  ///< files from which it was read; null if it was made in a program
  /// Recomputes everything that refers to robots and objects by index: teams, events, printed and recorded quantities.
  /// Called when another seed has given the world different instances. Throws InputError; null if the experiment was
  /// made in a program. Callable from any thread.
  std::function<void(Experiment&)> select_again{};
  /// Reads models that arrive as text while the world runs. They may refer only to files in `inputs`. Null if the
  /// experiment was made in a program that reads none.
  ModelReader read_model{};
};

}  // namespace cohort::description
