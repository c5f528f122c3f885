// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/engines/engine_kinds.hpp"

namespace cohort::bench {

struct Options {
  std::vector<std::string> scenes;    ///< empty: all
  std::vector<std::string> engines;   ///< empty: all that are in this build
  std::vector<std::uint32_t> robots;  ///< empty: the scene's own numbers
  double seconds = 1.0;               ///< simulated time of each repetition [s]
  unsigned repetitions = 5;
  unsigned threads = 1;  ///< above 1: Cohort runs with one thread and with this number
  std::uint64_t seed = 1;
};

/// Callbacks of a measurement, used between its parts.
struct Surroundings {
  std::function<void(const std::string&)> progress;
  const std::atomic<bool>& stop;
};
/// Thrown when `stop` was set.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Statistics of several repetitions.
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
  Spread cpu;                ///< CPU time of all threads for one robot and step [s]
  Spread wall;               ///< the same
  double touches = 0.0;      ///< touching pairs (two robots, or a robot and a wall) per robot
  double error = 0.0;        ///< largest error: overlap of two turrets, or deviation of a connection's length [m]
  double speed_ratio = 0.0;  ///< ratio of reached to commanded speed, driving straight and alone
  std::optional<double>
      against_reference;           ///< ratio of the reference engine's CPU time to this one's, median of repetitions
  std::optional<double> speed_up;  ///< ratio of the wall time with one thread to this one, median of repetitions
  /// The experimentally determined serial fraction (Karp and Flatt, "Measuring parallel processor performance", CACM
  /// 33(5), 1990): the serial fraction that would explain the speed-up if the rest were distributed evenly. It includes
  /// all other causes of waiting threads.
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

/// Builds `scene` in each engine, drives all for one second and then measures them alternately: one repetition of each
/// engine, then the next. Disturbances of the machine thus affect all engines alike.
StepResult measure_steps(const std::string& name, const Scene& scene, const std::vector<EngineKind>& engines,
                         const Options& options, const Surroundings& surroundings);

}  // namespace cohort::bench
