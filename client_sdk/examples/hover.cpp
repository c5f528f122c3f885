// SPDX-License-Identifier: Apache-2.0

// A quadcopter that rises to a height and hovers there. Cascaded proportional and derivative control regulates the
// height by the altimeter and the attitude by the IMU. The rotors are in front, on the left, behind and on the right,
// or in front and behind on both sides.
//
// It has no state. It does not measure its horizontal position, so it drifts after a gust.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cohort/controller.hpp>
#include <limits>

namespace {

// Properties of both models.
constexpr double weight = 0.716 * 9.81;         // [N]
constexpr double arm = 0.17;                    // [m]
constexpr double motor_constant = 8.54858e-06;  // thrust per squared velocity [N s^2/rad^2]
constexpr double moment_constant = 0.016;       // torque per thrust [m]
constexpr double inertia = 0.007;               // about x and y [kg m^2]
constexpr double yaw_inertia = 0.012;           // [kg m^2]

struct Rotor {
  const char* name;
  double forward, left;  // position in arm lengths
  double turn;           // 1 if it turns clockwise: its reaction torque turns the robot counter-clockwise
};
constexpr double diagonal = 0.7071067811865476;
constexpr std::array<Rotor, 4> plus = {
    {{"front", 1, 0, 1}, {"left", 0, 1, -1}, {"back", -1, 0, 1}, {"right", 0, -1, -1}}};
constexpr std::array<Rotor, 4> cross = {{{"rear_right", -diagonal, -diagonal, 1},
                                         {"front_right", diagonal, -diagonal, -1},
                                         {"rear_left", -diagonal, diagonal, -1},
                                         {"front_left", diagonal, diagonal, 1}}};

// Chosen stiffness and damping.
constexpr double height_rate = 2.0;    // [rad/s]
constexpr double attitude_rate = 8.0;  // [rad/s]
constexpr double yaw_rate = 2.0;       // [rad/s]
constexpr double damping_ratio = 0.9;
constexpr double most_climb = 0.3;  // greatest change of thrust, as a fraction of the weight
constexpr double descent = 0.3;     // speed of the landing [m/s]

// Returns the acceleration that reduces `error` to zero.
double control(double rate, double error, double velocity) {
  return -rate * (rate * error + 2.0 * damping_ratio * velocity);
}

class Hover final : public cohort::StatelessController {
 public:
  void start(const cohort::Start& start) override {
    const std::vector<double> heights = start.parameters.reals("heights");
    if (heights.empty()) throw cohort::ParameterError("heights", "expected one height per robot [m]");
    target_ = heights[start.robot % heights.size()];
    height_ = start.observation("altimeter/0/vertical_position");
    climb_ = start.observation("altimeter/0/vertical_velocity");
    orientation_ = start.observation("imu/0/orientation");
    turn_rate_ = start.observation("imu/0/angular_velocity");
    const bool is_plus = std::ranges::any_of(start.command_channels,
                                             [](const cohort::ChannelInfo& c) { return c.name == "front/0/velocity"; });
    arrangement_ = is_plus ? plus : cross;
    for (std::size_t i = 0; i < rotors_.size(); ++i)
      rotors_[i] = start.command(std::string(arrangement_[i].name) + "/0/velocity");
    heading_ = start.parameters.real("heading", 0.0);
    take_off_at_ = start.parameters.real("take_off_at", 0.0);
    land_at_ = start.parameters.real("land_at", std::numeric_limits<double>::max());
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const auto q = observation.values(orientation_);  // x y z w
    const auto w = observation.values(turn_rate_);
    // The vertical axis in the robot frame, and the robot's yaw.
    const double up_x = 2.0 * (q[0] * q[2] - q[3] * q[1]);
    const double up_y = 2.0 * (q[1] * q[2] + q[3] * q[0]);
    const double up_z = 1.0 - 2.0 * (q[0] * q[0] + q[1] * q[1]);
    const double yaw = std::atan2(2.0 * (q[3] * q[2] + q[0] * q[1]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]));
    const double turn = std::remainder(yaw - heading_, 2.0 * std::acos(-1.0));

    const double time = std::chrono::duration<double>(observation.time()).count();
    if (time < take_off_at_) return;  // the rotors are off
    const double target = time < land_at_ ? target_ : std::max(0.0, target_ - descent * (time - land_at_));

    const double climb = control(height_rate, observation[height_] - target, observation[climb_]) / 9.81;
    const double lift = weight * (1.0 + std::clamp(climb, -most_climb, most_climb)) / std::max(up_z, 0.5);
    const double roll = inertia * control(attitude_rate, up_y, w[0]) / (2.0 * arm);
    const double pitch = inertia * control(attitude_rate, -up_x, w[1]) / (2.0 * arm);
    const double spin = yaw_inertia * control(yaw_rate, turn, w[2]) / (4.0 * moment_constant);
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      const Rotor& rotor = arrangement_[i];
      const double thrust = lift / 4 - pitch * rotor.forward + roll * rotor.left + spin * rotor.turn;
      command.set(rotors_[i], std::sqrt(std::max(thrust, 0.0) / motor_constant));
    }
  }

 private:
  double target_ = 0.0;                       // height above the start [m]
  double heading_ = 0.0;                      // [rad]
  double take_off_at_ = 0.0, land_at_ = 0.0;  // [s]
  std::array<Rotor, 4> arrangement_{};
  cohort::ObservationChannel height_, climb_, orientation_, turn_rate_;
  std::array<cohort::CommandChannel, 4> rotors_;
};

}  // namespace

COHORT_CONTROLLER(Hover)
