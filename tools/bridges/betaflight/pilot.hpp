#pragma once

#include <numbers>
#include <optional>

#include "tools/bridges/betaflight/sitl_packets.hpp"

namespace cohort::betaflight {

/// The flight plan of a pilot, with its times [s].
struct Plan {
  double height = 1.0;       ///< to hover at, above where it starts [m]
  double take_off_at = 8.0;  ///< arms 2 s earlier, and takes off later if the flight controller does not arm
  double land_at = 70.0;
};

/// Flies a quadcopter by the sticks of a remote control as its plan has it: arms, takes off, hovers above where it
/// started, lands and disarms. It keeps height, place and heading; the flight controller, in its mode ANGLE, keeps the
/// angles that the sticks ask for.
class Pilot {
 public:
  explicit Pilot(const Plan& plan) : plan_(plan) {}

  /// Returns the sticks, `step` [s] after the last ones. The pilot sees position, velocity
  /// and orientation in the state, and hears whether motors turn.
  Channels fly(const State& state, bool motors_turn, double step);

  /// The angle that a stick asks for at its end [rad], as the configuration of the flight controller has it.
  static constexpr double greatest_angle = 30.0 * std::numbers::pi / 180.0;
  /// The rate that the yaw stick asks for at its end [rad/s].
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
  double hover_ = 0.4;             // throttle that keeps the height, as far as the pilot knows by now
  double on_floor_ = 0.0;          // how long it has stood there, to land [s]
};

}  // namespace cohort::betaflight
