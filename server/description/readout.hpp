// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Errors and delays between the measurement of a sensor and its report.
namespace cohort::description {

/// Noise on every value of a quantity, in its unit; each value has its own draws.
struct Noise {
  std::string quantity;          ///< last part of the names of the affected channels; empty for all. If two
                                 ///< apply to one value, the later one is used
  int element = -1;              ///< index of the affected value of these channels; -1 for all
  double mean = 0.0;             ///< mean of the Gaussian noise that is drawn for each sample
  double deviation = 0.0;        ///< standard deviation of it
  double uniform = 0.0;          ///< maximum magnitude of the uniform noise that is drawn for each sample
  double bias = 0.0;             ///< mean of a bias that is drawn once per run
  double bias_deviation = 0.0;   ///< standard deviation of it
  double drift_deviation = 0.0;  ///< standard deviation of a drifting bias in the steady state
  double drift_time = 0.0;       ///< correlation time of the drift [s]; 0 for no drift
  double precision = 0.0;        ///< readings are rounded to multiples of this; 0 for no rounding
};

/// Returns whether the noise has no effect.
inline bool is_exact(const Noise& noise) {
  return noise.mean == 0.0 && noise.deviation == 0.0 && noise.uniform == 0.0 && noise.bias == 0.0 &&
         noise.bias_deviation == 0.0 && noise.drift_deviation == 0.0 && noise.precision == 0.0;
}

/// Returns the variance of the errors that the noise adds, over all runs. Uniform errors up to a magnitude m have a
/// variance of m^2 / 3, and rounding to multiples of p one of p^2 / 12.
inline double variance_of(const Noise& noise) {
  return noise.deviation * noise.deviation + noise.uniform * noise.uniform / 3.0 +
         noise.bias_deviation * noise.bias_deviation + noise.drift_deviation * noise.drift_deviation +
         noise.precision * noise.precision / 12.0;
}

/// Returns the ratio of the standard deviation of a drifting bias to the density s [unit / sqrt(s)] of the white noise
/// w by which SDF defines it. The bias follows db/dt = -b / time + s w, so in the long run d/dt E[b^2] = -2 E[b^2] /
/// time + s^2 = 0, and the ratio is sqrt(time / 2).
inline double drift_from_density(double time) { return std::sqrt(0.5 * time); }

/// The readout of a sensor, which measures every `period` and reports each measurement `latency` later. If a report is
/// lost, the previous one remains valid. All readings are clipped to the ranges of their channels.
struct Readout {
  std::vector<Noise> noises;
  double drop_out = 0.0;               ///< probability that a report is lost
  std::chrono::nanoseconds period{0};  ///< 0 for every tick
  std::chrono::nanoseconds latency{0};
};

/// Returns the index of the noise on an element of a quantity's channel; -1 if there is none.
inline int noise_on(const Readout& readout, std::string_view quantity, std::uint32_t element) {
  int index = -1;
  for (std::size_t i = 0; i < readout.noises.size(); ++i) {
    const Noise& noise = readout.noises[i];
    if ((noise.quantity.empty() || noise.quantity == quantity) &&
        (noise.element < 0 || noise.element == static_cast<int>(element)))
      index = static_cast<int>(i);
  }
  return index;
}

/// Returns the variance of the errors of an element of a quantity's channel.
inline double variance_of(const Readout& readout, std::string_view quantity, std::uint32_t element = 0) {
  const int index = noise_on(readout, quantity, element);
  return index < 0 ? 0.0 : variance_of(readout.noises[static_cast<std::size_t>(index)]);
}

}  // namespace cohort::description
