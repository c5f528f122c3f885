// A quadcopter that rises to a height and hovers there: a cascade of proportional and derivative control, of the height
// by its altimeter and of its attitude by its IMU. Its rotors are in front, to the left, behind and to the right.
//
// It keeps nothing from one step to the next. Nothing tells it where it is from above: a gust leaves it drifting.

#include <algorithm>
#include <array>
#include <cmath>
#include <cohort/controller.hpp>

namespace {

// Of the model.
constexpr double weight = 0.716 * 9.81;         // [N]
constexpr double arm = 0.17;                    // [m]
constexpr double motor_constant = 8.54858e-06;  // thrust for each square of velocity [N s^2/rad^2]
constexpr double moment_constant = 0.016;       // torque for each newton of thrust [m]
constexpr double inertia = 0.007;               // about x and y [kg m^2]
constexpr double yaw_inertia = 0.012;           // [kg m^2]

// Chosen: how stiff and how damped each is.
constexpr double height_rate = 2.0;    // [rad/s]
constexpr double attitude_rate = 8.0;  // [rad/s]
constexpr double yaw_rate = 2.0;       // [rad/s]
constexpr double damping_ratio = 0.9;
constexpr double most_climb = 0.3;  // of the weight, more or less

// Acceleration towards where `error` is zero.
double control(double rate, double error, double velocity) {
  return -rate * (rate * error + 2.0 * damping_ratio * velocity);
}

class Hover final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    const std::vector<double> heights = start.parameters.reals("heights");
    if (heights.empty()) throw cohort::ParameterError("heights", "expected the heights of the robots [m]");
    target_ = heights[start.robot % heights.size()];
    height_ = start.observation("altimeter/0/vertical_position");
    climb_ = start.observation("altimeter/0/vertical_velocity");
    orientation_ = start.observation("imu/0/orientation");
    turn_rate_ = start.observation("imu/0/angular_velocity");
    const char* const names[] = {"front", "left", "back", "right"};
    for (std::size_t i = 0; i < rotors_.size(); ++i) rotors_[i] = start.command(std::string(names[i]) + "/0/velocity");
    heading_ = start.parameters.real("heading", 0.0);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const auto q = observation.values(orientation_);  // x y z w
    const auto w = observation.values(turn_rate_);
    // Upwards, in the axes of the robot; and its yaw.
    const double up_x = 2.0 * (q[0] * q[2] - q[3] * q[1]);
    const double up_y = 2.0 * (q[1] * q[2] + q[3] * q[0]);
    const double up_z = 1.0 - 2.0 * (q[0] * q[0] + q[1] * q[1]);
    const double yaw = std::atan2(2.0 * (q[3] * q[2] + q[0] * q[1]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]));
    const double turn = std::remainder(yaw - heading_, 2.0 * std::acos(-1.0));

    const double climb = control(height_rate, observation[height_] - target_, observation[climb_]) / 9.81;
    const double lift = weight * (1.0 + std::clamp(climb, -most_climb, most_climb)) / std::max(up_z, 0.5);
    const double roll = inertia * control(attitude_rate, up_y, w[0]) / (2.0 * arm);
    const double pitch = inertia * control(attitude_rate, -up_x, w[1]) / (2.0 * arm);
    const double spin = yaw_inertia * control(yaw_rate, turn, w[2]) / (4.0 * moment_constant);
    const std::array<double, 4> thrusts = {lift / 4 - pitch + spin, lift / 4 + roll - spin, lift / 4 + pitch + spin,
                                           lift / 4 - roll - spin};
    for (std::size_t i = 0; i < rotors_.size(); ++i)
      command.set(rotors_[i], std::sqrt(std::max(thrusts[i], 0.0) / motor_constant));
  }

  void save(cohort::StateWriter&) const override {}

 private:
  double target_ = 0.0;   // above where it starts [m]
  double heading_ = 0.0;  // [rad]
  cohort::ObservationChannel height_, climb_, orientation_, turn_rate_;
  std::array<cohort::CommandChannel, 4> rotors_;
};

}  // namespace

COHORT_CONTROLLER(Hover)
