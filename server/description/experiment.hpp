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
#include "server/description/world.hpp"

namespace cohort::description {

enum class OnLate { wait, hold, zero, detach, stop };

/// As experiments write it.
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
  lockstep,  ///< the world waits for each answer, as `on_late` says
  free,      ///< never waited for; the newest answer acts from the tick after which it came
};

/// What happens when another process takes a robot over whose controller is lost.
enum class OnLost {
  go_on,   ///< the new controller starts without what the former one remembered
  rewind,  ///< the run goes back to its last snapshot, where the state of controllers is known
};

/// When a robot's controller is asked, and what happens when it does not answer (docs/semantics.md).
struct Policy {
  std::uint32_t period = 1;  ///< asked every `period` ticks, >= 1
  std::uint32_t phase = 0;   ///< first asked at this tick, < period
  std::uint32_t delay = 0;   ///< the answer to frame k acts at tick k + delay
  OnLate on_late = OnLate::wait;
  /// Wall-clock patience: per tick; if free, since the last answer, zero being for ever. Not read under `wait`.
  std::chrono::nanoseconds deadline{0};
  Mode mode = Mode::lockstep;
  bool required = true;  ///< the run does not start, or go on, without a controller
  OnLost on_lost = OnLost::go_on;
};

/// What to do about a controller process that dies.
enum class Restart { on_failure, never };

/// What the experiment gives a team's controllers. Nested maps are flattened: their keys are joined by '.'.
struct Parameter {
  std::string name;
  std::vector<std::string> values;  ///< one, or those of a list, as they are written
  int line = 0;                     ///< in the experiment's file
};

/// Robots that share a controller and a policy.
struct Team {
  std::string name;
  std::vector<std::uint32_t> robots;  ///< ids, ascending
  std::string controller;             ///< plugin name, or a path to a plugin; empty: none
  Policy policy;
  Restart restart = Restart::on_failure;
  std::vector<Parameter> parameters{};  ///< of the controllers, in the file's order
  int controller_line = 0;              ///< of the key `controller` in the file
};

struct Experiment {
  std::filesystem::path file;
  std::string name;  ///< the file's, without the extension
  World world;
  std::uint64_t seed = 1;
  std::chrono::nanoseconds duration{0};
  std::vector<Team> teams;    ///< every robot is in exactly one
  unsigned threads = 0;       ///< that step the world; 0: as many as there are cores
  std::vector<Event> events;  ///< in the order of their times, and of the file
  std::vector<Reaction> reactions;
  std::vector<Spawner> spawners{};
  std::vector<StopCondition> stops;
  std::vector<PrintedQuantity> prints;
  History history;
  Recorded recorded;
  std::shared_ptr<const KeptFiles> inputs{};  ///< what it was read from; null if it was made in a program
  /// Sets again what refers to robots and objects by index: teams, events, what is printed and recorded. Called when
  /// the world has got other instances with another seed. Throws InputError; null if the experiment was made in a
  /// program. Callable from any thread.
  std::function<void(Experiment&)> select_again{};
  /// Reads models that come as text while the world runs. They may name only files that are in `inputs`. Null if the
  /// experiment was made in a program that reads none.
  ModelReader read_model{};
};

}  // namespace cohort::description
