// SPDX-License-Identifier: Apache-2.0

// Phototaxis and assembly (thesis, section 5.2.3), for the s-bot: it drives to the light, and grips any robot or object
// that it can. Connected robots turn their chassis under their turrets towards the light, and so move as one.
//
// Its only state is the remaining time in which it turns away from an object that it could not grip.

#include <algorithm>
#include <cmath>
#include <cohort/sbot.hpp>

namespace {

constexpr double full_speed = 0.1;     // speed of a track [m/s]
constexpr double turning_gain = 0.15;  // speed of a track per angle to the light [m/s]
constexpr double arrived = 0.97;       // reading of the brightest light sensor, about 0.5 m from a lamp of intensity 1
constexpr double darkness = 0.03;      // greatest noise of a light sensor in darkness
constexpr double in_the_way = 0.5;     // proximity reading at 10 cm
constexpr double touching = 0.97;      // proximity reading at 6 mm, nearer than the range of a gripper
constexpr double avoiding_time = 1.5;  // after a failed grip [s]
constexpr double avoiding_speed = 0.05;  // speed of a track [m/s]
constexpr double tone = 1000.0;          // call of a gripping robot [Hz]
constexpr double call = 0.005;           // intensity of a call at 1 m [1]
constexpr double next_to = 0.13;         // microphone reading of a call within 13 cm

class Assembly final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    step_ = start.seconds_per_step();
    avoiding_for_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const bool grips = robot_.grips(observation);
    const bool is_closing = grips || robot_.can_grip(observation);
    if (is_closing) robot_.close_gripper(command);
    if (grips) robot_.call(command, tone, call);
    const bool is_member = grips || robot_.hears(observation, next_to);
    robot_.shine(command, is_member ? cohort::Sbot::Color::red : cohort::Sbot::Color::blue);

    const cohort::Sbot::Light light = robot_.look(observation);
    if (is_member)
      move_as_one(observation, light, command);
    else if (!is_closing)
      move_alone(observation, light, command);
  }

  void save(cohort::StateWriter& state) const override { state.write(avoiding_for_); }
  void load(cohort::StateReader& state) override { state.read(avoiding_for_); }

 private:
  // The turret is held, so its motor turns the chassis.
  void move_as_one(const cohort::Observation& observation, const cohort::Sbot::Light& light,
                   cohort::Command& command) const {
    if (light.brightest < darkness || light.brightest > arrived) return;
    const double off = robot_.from_chassis(observation, light.bearing);
    robot_.turn_turret_back(command, off);
    drive(off, command);
  }

  void move_alone(const cohort::Observation& observation, const cohort::Sbot::Light& light, cohort::Command& command) {
    robot_.align_turret(observation, command);
    const double ahead = std::max(observation[robot_.proximity.front()], observation[robot_.proximity.back()]);
    const double left = std::max(observation[robot_.proximity[1]], observation[robot_.proximity[2]]);
    const double right = std::max(observation[robot_.proximity[13]], observation[robot_.proximity[12]]);
    if (ahead > touching) avoiding_for_ = avoiding_time;
    if (avoiding_for_ > 0.0) {
      avoiding_for_ -= step_;
      robot_.turn(command, 0.0, avoiding_speed);
    } else if (std::max(left, right) > in_the_way) {
      // The obstacle may be an object to grip: drive towards it.
      drive(left > right ? 0.5 : -0.5, command);
    } else if (ahead > in_the_way || light.brightest < darkness) {
      drive(0.0, command);
    } else {
      drive(robot_.from_chassis(observation, light.bearing), command);
    }
  }
  void drive(double towards, cohort::Command& command) const {
    const double ahead = full_speed * std::max(0.0, std::cos(towards));
    robot_.turn(command, ahead, turning_gain * towards);
  }

  cohort::Sbot robot_;
  double step_ = 0.0;          // time from one answer to the next [s]
  double avoiding_for_ = 0.0;  // [s]
};

}  // namespace

COHORT_CONTROLLER(Assembly)
