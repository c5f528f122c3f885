#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/bench/engines/engine_kinds.hpp"

namespace cohort::bench {

struct Options {
  std::vector<std::string> scenes;    ///< empty: all
  std::vector<std::string> engines;   ///< empty: all that are in this build
  std::vector<std::uint32_t> robots;  ///< empty: those of the scene
  double seconds = 1.0;               ///< simulated, of each repetition
  unsigned repetitions = 5;
  unsigned threads = 1;  ///< above 1: Cohort runs with one thread and with these
  std::uint64_t seed = 1;
};

/// What a measurement asks between its parts.
struct Surroundings {
  std::function<void(const std::string&)> progress;
  const std::atomic<bool>& stop;
};
/// Thrown when `stop` was set.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Of several repetitions.
struct Spread {
  double median = 0.0;
  double least = 0.0;
  double most = 0.0;
};
Spread spread_of(std::vector<double> values);

struct LeftOut {
  std::string engine;
  std::string reason;
};

struct StepCost {
  std::string engine;
  unsigned threads = 1;
  Spread cpu;                ///< of all threads, of one robot and step [s]
  Spread wall;               ///< the same
  double touches = 0.0;      ///< pairs that touch, of robots or of a robot and a wall, for each robot
  double error = 0.0;        ///< the worst: of two turrets the overlap, of a connection's length what it is off [m]
  double speed_ratio = 0.0;  ///< reached to commanded, straight on and alone
  std::optional<double> against_reference;  ///< CPU time of the reference engine to this one's, median of repetitions
  std::optional<double> speed_up;           ///< wall time with one thread to this, median of repetitions
  /// The share of the work that, were the rest spread evenly, would explain the speed-up (Karp and Flatt, "Measuring
  /// parallel processor performance", CACM 33(5), 1990): what is serial, and all else that keeps threads waiting.
  std::optional<double> serial_share;
};

struct StepResult {
  std::string scene;
  bool connected = false;
  std::uint32_t robots = 0;
  double step = 0.0;  ///< [s]
  std::vector<StepCost> costs;
  std::vector<LeftOut> left_out;
};

/// Builds `scene` in each engine, lets all drive for a second and then measures them in turns: one repetition of each,
/// then the next of each, so that whatever disturbs the machine disturbs all alike.
StepResult measure_steps(const std::string& name, const Scene& scene, const std::vector<EngineKind>& engines,
                         const Options& options, const Surroundings& surroundings);

}  // namespace cohort::bench
