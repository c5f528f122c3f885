// A swarm retrieves what is too heavy for one (thesis, figure 1.2a). An s-bot goes where the prey calls, grips it,
// turns its chassis under its turret towards the light and drives: as soon as enough of them pull and push, the prey
// moves.
//
// It keeps nothing from one step to the next but how long it still goes around another robot.

#include <algorithm>
#include <cmath>
#include <cohort/sbot.hpp>
#include <numbers>

namespace {

constexpr double full_speed = 0.12;    // of a track [m/s]
constexpr double turning_gain = 0.15;  // of a track, of the angle to where it wants to go [m/s]
constexpr double in_the_way = 0.6;     // of a proximity sensor: 8 cm
constexpr double around_time = 1.0;    // that it goes around what is in the way [s]
constexpr double around = 1.2;         // to its side [rad]
constexpr double call_at_prey = 0.4;   // what is heard next to the prey, and not one robot further out
constexpr double darkness = 0.03;      // what the noise of a light sensor may give without any light
constexpr double slow_down = 1.0;      // of the angle to the light: from here on it only turns [rad]

class Retrieval final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    step_ = start.seconds_per_step();
    around_for_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const cohort::Sbot::Sound sound = robot_.listen(observation);
    const bool grips = robot_.grips(observation);
    robot_.shine(command, grips ? cohort::Sbot::Color::red : cohort::Sbot::Color::blue);
    if (grips || (robot_.can_grip(observation) && sound.level > call_at_prey)) robot_.close_gripper(command);
    if (grips)
      carry(observation, command);
    else
      approach(observation, sound, command);
  }

  void save(cohort::StateWriter& state) const override { state.write(around_for_); }
  void load(cohort::StateReader& state) override { state.read(around_for_); }

 private:
  void approach(const cohort::Observation& observation, const cohort::Sbot::Sound& sound, cohort::Command& command) {
    robot_.align_turret(observation, command);
    double ahead = 0.0;
    for (const std::size_t i : {0u, 1u, 13u, 14u}) ahead = std::max(ahead, observation[robot_.proximity[i]]);
    const bool is_at_prey = sound.level > call_at_prey;
    if (ahead > in_the_way && !is_at_prey) around_for_ = around_time;
    around_for_ = is_at_prey ? 0.0 : std::max(0.0, around_for_ - step_);
    // Others are passed on the right.
    const double to = sound.bearing() + observation[robot_.turret] - (around_for_ > 0.0 ? around : 0.0);
    drive(std::remainder(to, 2.0 * std::numbers::pi), ahead > in_the_way ? 0.4 : 1.0, command);
  }

  // The prey holds the turret, so its motor turns the chassis.
  void carry(const cohort::Observation& observation, cohort::Command& command) const {
    const cohort::Sbot::Light light = robot_.look(observation);
    if (light.brightest < darkness) return;
    const double off = robot_.from_chassis(observation, light.bearing);
    robot_.turn_turret_back(command, off);
    drive(off, std::abs(off) < slow_down ? 1.0 : 0.0, command);
  }

  void drive(double towards, double share, cohort::Command& command) const {
    const double ahead = share * full_speed * std::max(0.0, std::cos(towards));
    robot_.turn(command, ahead, turning_gain * towards);
  }

  cohort::Sbot robot_;
  double step_ = 0.0;        // from one answer to the next [s]
  double around_for_ = 0.0;  // [s]
};

}  // namespace

COHORT_CONTROLLER(Retrieval)
