// Phototaxis and assembly (thesis, section 5.2.3), for the s-bot: it goes to the light, and grips whatever it can.
// Those that hold on to each other turn their chassis under their turrets towards the light, and so move as one.
//
// It keeps nothing from one step to the next but how long it still turns away from what it could not grip.

#include <algorithm>
#include <cmath>
#include <cohort/controller.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "sbot_senses.hpp"

namespace {

constexpr double full_speed = 0.1;       // of a track [m/s]
constexpr double turning_gain = 0.15;    // of a track, of the angle to the light [m/s]
constexpr double turret_gain = 5.0;      // [1/s]
constexpr double arrived = 0.97;         // of the brightest light sensor: some 0.5 m from a lamp of intensity 1
constexpr double darkness = 0.03;        // what the noise of a sensor may give without any light
constexpr double in_the_way = 0.5;       // of a proximity sensor: 10 cm
constexpr double touching = 0.97;        // of a proximity sensor: 6 mm, nearer than what a gripper grips
constexpr double avoiding_time = 1.5;    // after what could not be gripped [s]
constexpr double avoiding_speed = 0.05;  // of a track [m/s]
constexpr double tone = 1000.0;          // of who grips [Hz]
constexpr double call = 0.005;           // what arrives of it at 1 m [1]
constexpr double next_to = 0.13;         // of a microphone: one that calls within 13 cm

class Assembly final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    light_ = start.observations("light/*/reading");
    microphones_ = start.observations("microphones/*/intensity");
    if (proximity_.size() != 15 || light_.size() != 8)
      throw std::runtime_error("this controller wants the 15 proximity sensors and the 8 light sensors of an s-bot");
    grippable_ = start.observation("gripper/0/grippable");
    gripping_ = start.observation("gripper/0/gripping");
    turret_position_ = start.observation("turret/0/position");
    opening_ = start.command("gripper/0/opening");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    frequency_ = start.command("left_speaker/0/frequency");
    loudness_ = start.command("left_speaker/0/intensity");
    colors_ = start.commands("leds/*/color");
    step_ = std::chrono::duration<double>(start.step).count() * start.period;
    avoiding_for_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const bool grips = observation[gripping_] > 0.5;
    const bool is_closing = grips || observation[grippable_] > 0.5;
    if (is_closing) command.set(opening_, 0.0);
    if (grips) {
      command.set(frequency_, tone);
      command.set(loudness_, call);
    }
    const bool is_member = grips || sbot::hears(observation, microphones_, next_to);
    for (const cohort::CommandChannel led : colors_) command.set(led, 1.0, is_member ? 0 : 2);  // red or blue

    const sbot::Light light = sbot::look(observation, light_);
    if (is_member)
      move_as_one(observation, light, command);
    else if (!is_closing)
      move_alone(observation, light, command);
  }

 private:
  // The turret is held, so its motor turns the chassis.
  void move_as_one(const cohort::Observation& observation, const sbot::Light& light, cohort::Command& command) const {
    if (light.brightest < darkness || light.brightest > arrived) return;
    const double off = std::remainder(light.bearing + observation[turret_position_], 2.0 * std::numbers::pi);
    command.set(turret_velocity_, -turret_gain * off);
    drive(off, command);
  }

  void move_alone(const cohort::Observation& observation, const sbot::Light& light, cohort::Command& command) {
    command.set(turret_velocity_, -turret_gain * observation[turret_position_]);
    const double ahead = std::max(observation[proximity_.front()], observation[proximity_.back()]);
    const double left = std::max(observation[proximity_[1]], observation[proximity_[2]]);
    const double right = std::max(observation[proximity_[13]], observation[proximity_[12]]);
    if (ahead > touching) avoiding_for_ = avoiding_time;
    if (avoiding_for_ > 0.0) {
      avoiding_for_ -= step_;
      command.set(left_track_, -avoiding_speed);
      command.set(right_track_, avoiding_speed);
    } else if (std::max(left, right) > in_the_way) {
      // It may be one to grip: towards it.
      drive(left > right ? 0.5 : -0.5, command);
    } else if (ahead > in_the_way || light.brightest < darkness) {
      drive(0.0, command);
    } else {
      drive(std::remainder(light.bearing + observation[turret_position_], 2.0 * std::numbers::pi), command);
    }
  }
  void drive(double towards, cohort::Command& command) const {
    const double ahead = full_speed * std::max(0.0, std::cos(towards));
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
  cohort::CommandChannel frequency_;
  cohort::CommandChannel loudness_;
  std::vector<cohort::CommandChannel> colors_;
  double step_ = 0.0;          // from one answer to the next [s]
  double avoiding_for_ = 0.0;  // [s]
};

}  // namespace

COHORT_CONTROLLER(Assembly)
