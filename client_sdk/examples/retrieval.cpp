// SPDX-License-Identifier: Apache-2.0

// A swarm retrieves an object that is too heavy for one robot, the prey (thesis, figure 1.2a). An s-bot drives towards
// the call of the prey, grips it, turns its chassis under its turret towards the light and drives. The prey moves as
// soon as enough robots pull and push.
//
// A robot that others keep from gripping would push the prey the wrong way: it drives back soon, and comes from another
// side. Its only state is two times: how long it has been at the prey, and how long it still drives back or around.

#include <algorithm>
#include <cmath>
#include <cohort/sbot.hpp>
#include <numbers>

namespace {

constexpr double full_speed = 0.12;    // speed of a track [m/s]
constexpr double turning_gain = 0.15;  // speed of a track per angle to the target [m/s]
constexpr double in_the_way = 0.6;     // proximity reading at 8 cm
constexpr double around_time = 1.0;    // duration of driving around an obstacle [s]
constexpr double back_time = 1.5;      // duration of driving back before that, if it cannot grip the prey [s]
constexpr double patience = 4.0;       // time at the prey after which it drives back [s]
constexpr double around = 1.2;         // angle of driving around an obstacle [rad]
constexpr double call_at_prey = 0.4;   // sound level near the prey, within 35 cm of its centre
constexpr double darkness = 0.03;      // greatest noise of a light sensor in darkness
constexpr double slow_down = 1.0;      // angle to the light from which on it only turns [rad]

class Retrieval final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    step_ = start.seconds_per_step();
    around_for_ = 0.0;
    at_prey_for_ = 0.0;
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

  void save(cohort::StateWriter& state) const override {
    state.write(around_for_);
    state.write(at_prey_for_);
  }
  void load(cohort::StateReader& state) override {
    state.read(around_for_);
    state.read(at_prey_for_);
  }

 private:
  void approach(const cohort::Observation& observation, const cohort::Sbot::Sound& sound, cohort::Command& command) {
    robot_.align_turret(observation, command);
    double ahead = 0.0;
    for (const std::size_t i : {0u, 1u, 13u, 14u}) ahead = std::max(ahead, observation[robot_.proximity[i]]);
    const bool is_at_prey = sound.level > call_at_prey;
    at_prey_for_ = is_at_prey && around_for_ == 0.0 ? at_prey_for_ + step_ : 0.0;
    if (ahead > in_the_way && !is_at_prey) around_for_ = std::max(around_for_, around_time);
    if (at_prey_for_ > patience) around_for_ = back_time + around_time;
    around_for_ = std::max(0.0, around_for_ - step_);
    if (around_for_ > around_time) return robot_.turn(command, -full_speed, 0.0);
    // Pass other robots on the right.
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
  double step_ = 0.0;         // time from one answer to the next [s]
  double around_for_ = 0.0;   // [s]
  double at_prey_for_ = 0.0;  // [s]
};

}  // namespace

COHORT_CONTROLLER(Retrieval)
