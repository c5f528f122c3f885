// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>

#include "tools/bridges/betaflight/sitl_packets.hpp"

namespace cohort::betaflight {

/// The flight plan of a pilot, with its times [s].
struct Plan {
  double height = 1.0;       ///< height of hovering above the start [m]
  double take_off_at = 8.0;  ///< arms 2 s earlier, and takes off later if the flight controller does not arm
  double land_at = 70.0;
};

/// A pilot who flies a quadcopter by remote control according to a plan: arms, takes off, hovers above the start, lands
/// and disarms. The pilot holds height, position and heading; the flight controller, in mode ANGLE, holds the attitude
/// set by the sticks.
class Pilot {
 public:
  explicit Pilot(const Plan& plan) : plan_(plan) {}

  /// Returns the stick positions, `step` [s] after the last call. The pilot uses position, velocity and orientation of
  /// the state, and whether the motors turn.
  Channels fly(const State& state, bool motors_turn, double step);

  /// The angle at full deflection of a stick [rad], as in the configuration of the flight controller.
  static constexpr double greatest_angle = 30.0 * std::numbers::pi / 180.0;
  /// The yaw rate at full deflection of the yaw stick [rad/s].
  static constexpr double greatest_yaw_rate = 200.0 * std::numbers::pi / 180.0;

 private:
  double throttle(const State& state, double step);
  bool arms(double time, bool motors_turn);

  Plan plan_;
  std::optional<double> took_off_at_;  // [s]
  double armed_at_ = 0.0;              // the switch went up [s]
  bool is_up_ = false;                 // the switch
  bool has_landed_ = false;
  std::optional<double> heading_;  // at take-off [rad]
  double climb_ = 0.0;             // smoothed [m/s]
  double hover_ = 0.4;             // estimated throttle that holds the height
  double on_floor_ = 0.0;          // time on the floor while landing [s]
};

}  // namespace cohort::betaflight
