#pragma once

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

/// What lies between what a sensor measures and what it reports.
namespace cohort::description {

/// Errors of every value of a quantity, in its unit, each value with its own draws.
struct Noise {
  std::string quantity;    ///< the last part of the names of the channels that it is on; empty: all of them. Of two
                           ///< that are on a value the later one holds
  int element = -1;        ///< which value of those channels it is on; -1: each
  double mean = 0.0;       ///< of the Gaussian noise that is drawn for each sample
  double deviation = 0.0;  ///< its standard deviation
  double uniform = 0.0;    ///< greatest size of the uniform noise that is drawn for each sample
  double bias = 0.0;       ///< mean of a bias that is drawn once in a run
  double bias_deviation = 0.0;   ///< its standard deviation
  double drift_deviation = 0.0;  ///< standard deviation of a bias that wanders, as it is after a long time
  double drift_time = 0.0;       ///< in which it forgets itself [s]; 0: it does not wander
  double precision = 0.0;        ///< readings are whole multiples of this; 0: of any value
};

/// Whether it changes nothing.
inline bool is_exact(const Noise& noise) {
  return noise.mean == 0.0 && noise.deviation == 0.0 && noise.uniform == 0.0 && noise.bias == 0.0 &&
         noise.bias_deviation == 0.0 && noise.drift_deviation == 0.0 && noise.precision == 0.0;
}

/// SDF gives a bias that wanders by the density s of the white noise that drives it [unit / sqrt(s)], in
/// db/dt = -b / time + s w. In the long run d/dt E[b^2] = -2 E[b^2] / time + s^2 = 0: its deviation is s times this,
/// sqrt(time / 2).
inline double drift_from_density(double time) { return std::sqrt(0.5 * time); }

/// A sensor measures every `period`; what it measured is reported `latency` later, and until the next report. A report
/// that drops out does not come, and the one before it holds. All readings are kept in the ranges of their channels.
struct Readout {
  std::vector<Noise> noises;
  double drop_out = 0.0;               ///< probability that a report does not come
  std::chrono::nanoseconds period{0};  ///< 0: every tick
  std::chrono::nanoseconds latency{0};
};

}  // namespace cohort::description
