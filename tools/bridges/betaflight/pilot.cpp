// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cohort::betaflight {
namespace {

constexpr double gravity = 9.81;
constexpr double armed_before_take_off = 2.0;  // [s]
constexpr double tries_every = 0.5;            // to arm [s]
constexpr double ascent = 0.5;                 // [m/s]
constexpr double descent = 0.3;                // [m/s]
constexpr double is_down = 0.05;               // [m]
constexpr double down_for = 1.0;               // [s]

// Chosen: how stiff each loop is. Each is slower than the one that it commands.
constexpr double height_gain = 1.2;       // [1/s]
constexpr double fastest_climb = 0.6;     // [m/s]
constexpr double climb_gain = 0.12;       // throttle for each m/s
constexpr double hover_gain = 0.12;       // throttle for each m
constexpr double climb_smoothing = 0.05;  // [s]
constexpr double place_gain = 0.8;        // [1/s]
constexpr double fastest = 0.8;           // [m/s]
constexpr double velocity_gain = 1.5;     // [1/s]
constexpr double most_tilt = 0.17;        // [rad]
constexpr double yaw_gain = 1.0;          // [1/s]

constexpr std::uint16_t low = 1000;
constexpr std::uint16_t high = 2000;

std::uint16_t pulse(double stick) {
  return static_cast<std::uint16_t>(std::lround(1500.0 + 500.0 * std::clamp(stick, -1.0, 1.0)));
}

double yaw_of(const std::array<double, 4>& q) {
  return std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

// Acceleration towards where it started [m/s^2].
double homewards(double place, double velocity) {
  return velocity_gain * (std::clamp(-place_gain * place, -fastest, fastest) - velocity);
}

}  // namespace

Channels Pilot::fly(const State& state, bool motors_turn, double step) {
  Channels channels;
  channels.fill(low);
  channels[0] = channels[1] = channels[3] = pulse(0.0);
  channels[5] = high;  // AUX2: the mode ANGLE
  if (state.time < plan_.take_off_at - armed_before_take_off || has_landed_) return channels;
  channels[4] = arms(state.time, motors_turn) ? high : low;  // AUX1
  if (!took_off_at_ && motors_turn && state.time >= plan_.take_off_at) took_off_at_ = state.time;
  if (!took_off_at_) return channels;

  channels[2] = pulse(2.0 * throttle(state, step) - 1.0);
  const double yaw = yaw_of(state.orientation);
  if (!heading_) heading_ = yaw;
  channels[3] = pulse(yaw_gain * std::remainder(yaw - *heading_, 2.0 * std::numbers::pi) / greatest_yaw_rate);
  const double north = homewards(state.position[0], state.velocity[0]);
  const double west = homewards(state.position[1], state.velocity[1]);
  const double forward = std::cos(yaw) * north + std::sin(yaw) * west;
  const double left = -std::sin(yaw) * north + std::cos(yaw) * west;
  const auto tilt = [](double acceleration) {
    return std::clamp(acceleration / gravity, -most_tilt, most_tilt) / greatest_angle;
  };
  channels[0] = pulse(tilt(-left));
  channels[1] = pulse(tilt(forward));
  return channels;
}

// A flight controller that is not ready as yet wants the switch down before it is up again.
bool Pilot::arms(double time, bool motors_turn) {
  if (!motors_turn && !took_off_at_ && time - armed_at_ > tries_every) {
    is_up_ = !is_up_;
    armed_at_ = time;
  }
  return is_up_;
}

double Pilot::throttle(const State& state, double step) {
  const double height = state.position[2];
  const bool lands = state.time >= plan_.land_at;
  const double target = lands ? plan_.height - descent * (state.time - plan_.land_at)
                              : std::min(plan_.height, ascent * (state.time - *took_off_at_));
  climb_ += (state.velocity[2] - climb_) * step / (step + climb_smoothing);
  const double error = std::clamp(height_gain * (target - height), -fastest_climb, fastest_climb) - climb_;
  hover_ = std::clamp(hover_ + hover_gain * error * step, 0.0, 1.0);
  on_floor_ = lands && height < is_down ? on_floor_ + step : 0.0;
  has_landed_ = on_floor_ > down_for;
  return std::clamp(hover_ + climb_gain * error, 0.0, 1.0);
}

}  // namespace cohort::betaflight
