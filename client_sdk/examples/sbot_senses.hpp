#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cohort/controller.hpp>
#include <numbers>
#include <span>

/// Where an s-bot's light sensors and microphones say that something is. Bearings are from where the turret looks,
/// counter-clockwise [rad].
namespace sbot {

struct Light {
  double bearing = 0.0;
  double brightest = 0.0;  ///< of the sensors
};

/// From a ring of sensors all round, the first of which looks ahead: the direction of their sum.
inline Light look(const cohort::Observation& observation, std::span<const cohort::ObservationChannel> sensors) {
  double ahead = 0.0, left = 0.0, brightest = 0.0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double reading = observation[sensors[i]];
    const double bearing = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sensors.size());
    ahead += reading * std::cos(bearing);
    left += reading * std::sin(bearing);
    brightest = std::max(brightest, reading);
  }
  return {std::atan2(left, ahead), brightest};
}

struct Sound {
  double bearing = 0.0;
  double level = 0.0;  ///< what arrives, the mean of the microphones
};

/// From four microphones at the corners of a square, the first one ahead and to the left. Undoes their saturation, 2 /
/// (1 + exp(-x)) - 1.
inline Sound listen(const cohort::Observation& observation, std::span<const cohort::ObservationChannel> microphones) {
  std::array<double, 4> heard{};
  for (std::size_t i = 0; i < heard.size(); ++i)
    heard[i] = -std::log(2.0 / (1.0 + std::min(observation[microphones[i]], 0.999999)) - 1.0);
  const double ahead = heard[0] + heard[3] - heard[1] - heard[2];
  const double left = heard[0] + heard[1] - heard[2] - heard[3];
  return {std::atan2(left, ahead), (heard[0] + heard[1] + heard[2] + heard[3]) / 4.0};
}

/// Whether any of the microphones reads more than `threshold`.
inline bool hears(const cohort::Observation& observation, std::span<const cohort::ObservationChannel> microphones,
                  double threshold) {
  return std::any_of(microphones.begin(), microphones.end(),
                     [&](cohort::ObservationChannel microphone) { return observation[microphone] > threshold; });
}

}  // namespace sbot
