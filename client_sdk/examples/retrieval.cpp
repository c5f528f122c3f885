// A swarm retrieves what is too heavy for one (thesis, figure 1.2a). An s-bot goes where the prey calls, grips it,
// turns its chassis under its turret towards the light and drives: as soon as enough of them pull and push, the prey
// moves.
//
// It keeps nothing from one step to the next but how long it still goes around another robot.

#include <algorithm>
#include <cmath>
#include <cohort/controller.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "sbot_senses.hpp"

namespace {

constexpr double full_speed = 0.12;    // of a track [m/s]
constexpr double turning_gain = 0.15;  // of a track, of the angle to where it wants to go [m/s]
constexpr double turret_gain = 5.0;    // [1/s]
constexpr double in_the_way = 0.6;     // of a proximity sensor: 8 cm
constexpr double around_time = 1.0;    // that it goes around what is in the way [s]
constexpr double around = 1.2;         // to its side [rad]
constexpr double call_at_prey = 0.4;   // what is heard next to the prey, and not one robot further out
constexpr double darkness = 0.03;      // what the noise of a light sensor may give without any light
constexpr double slow_down = 1.0;      // of the angle to the light: from here on it only turns [rad]

class Retrieval final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    light_ = start.observations("light/*/reading");
    microphones_ = start.observations("microphones/*/intensity");
    if (proximity_.size() != 15 || light_.size() != 8 || microphones_.size() != 4)
      throw std::runtime_error(
          "this controller wants the proximity sensors, light sensors and microphones of an s-bot");
    grippable_ = start.observation("gripper/0/grippable");
    gripping_ = start.observation("gripper/0/gripping");
    turret_position_ = start.observation("turret/0/position");
    opening_ = start.command("gripper/0/opening");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    colors_ = start.commands("leds/*/color");
    step_ = std::chrono::duration<double>(start.step).count() * start.period;
    around_for_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const sbot::Sound sound = sbot::listen(observation, microphones_);
    const bool grips = observation[gripping_] > 0.5;
    for (const cohort::CommandChannel led : colors_) command.set(led, 1.0, grips ? 0 : 2);  // red or blue
    if (grips || (observation[grippable_] > 0.5 && sound.level > call_at_prey)) command.set(opening_, 0.0);
    if (grips)
      carry(observation, command);
    else
      approach(observation, sound, command);
  }

 private:
  void approach(const cohort::Observation& observation, const sbot::Sound& sound, cohort::Command& command) {
    command.set(turret_velocity_, -turret_gain * observation[turret_position_]);
    double ahead = 0.0;
    for (const std::size_t i : {0u, 1u, 13u, 14u}) ahead = std::max(ahead, observation[proximity_[i]]);
    const bool is_at_prey = sound.level > call_at_prey;
    if (ahead > in_the_way && !is_at_prey) around_for_ = around_time;
    around_for_ = is_at_prey ? 0.0 : std::max(0.0, around_for_ - step_);
    // Others are passed on the right.
    const double to = sound.bearing + observation[turret_position_] - (around_for_ > 0.0 ? around : 0.0);
    drive(std::remainder(to, 2.0 * std::numbers::pi), ahead > in_the_way ? 0.4 : 1.0, command);
  }

  // The prey holds the turret, so its motor turns the chassis.
  void carry(const cohort::Observation& observation, cohort::Command& command) const {
    const sbot::Light light = sbot::look(observation, light_);
    if (light.brightest < darkness) return;
    const double off = std::remainder(light.bearing + observation[turret_position_], 2.0 * std::numbers::pi);
    command.set(turret_velocity_, -turret_gain * off);
    drive(off, std::abs(off) < slow_down ? 1.0 : 0.0, command);
  }

  void drive(double towards, double share, cohort::Command& command) const {
    const double ahead = share * full_speed * std::max(0.0, std::cos(towards));
    command.set(left_track_, ahead - turning_gain * towards);
    command.set(right_track_, ahead + turning_gain * towards);
  }

  std::vector<cohort::ObservationChannel> proximity_;
  std::vector<cohort::ObservationChannel> light_;
  std::vector<cohort::ObservationChannel> microphones_;
  cohort::ObservationChannel grippable_;
  cohort::ObservationChannel gripping_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel opening_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
  std::vector<cohort::CommandChannel> colors_;
  double step_ = 0.0;        // from one answer to the next [s]
  double around_for_ = 0.0;  // [s]
};

}  // namespace

COHORT_CONTROLLER(Retrieval)
