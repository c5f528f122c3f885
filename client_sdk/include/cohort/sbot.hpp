// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cohort/controller.hpp>
#include <numbers>
#include <vector>

namespace cohort {

/// The channels of an s-bot's devices (docs/sbot.md), and functions for common behaviours. A controller creates this
/// object in `start` and uses it in `step`. Bearings are relative to the turret's heading, counter-clockwise [rad].
struct Sbot {
  enum class Color : std::size_t { red, green, blue };
  struct Sides {
    double left = 0.0;
    double right = 0.0;
  };
  struct Light {
    double bearing = 0.0;
    double brightest = 0.0;  ///< greatest reading of the light sensors
  };
  struct Sound {
    double ahead = 0.0;  ///< intensity ahead minus intensity behind
    double left = 0.0;   ///< intensity on the left minus intensity on the right
    double level = 0.0;  ///< mean intensity at the microphones

    double bearing() const { return std::atan2(left, ahead); }
  };

  Sbot() = default;
  /// Looks up the channels. Throws ChannelError if the robot is not an s-bot.
  explicit Sbot(const Start& start)
      : proximity(start.observations("proximity/*/reading", 15)),
        ground(start.observations("ground/*/reading", 4)),
        light(start.observations("light/*/reading", 8)),
        microphones(start.observations("microphones/*/intensity", 4)),
        turret(start.observation("turret/0/position")),
        grippable(start.observation("gripper/0/grippable")),
        gripping(start.observation("gripper/0/gripping")),
        left_track(start.command("treel/left/velocity")),
        right_track(start.command("treel/right/velocity")),
        turret_motor(start.command("turret/0/velocity")),
        gripper(start.command("gripper/0/opening")),
        frequency(start.command("left_speaker/0/frequency")),
        loudness(start.command("left_speaker/0/intensity")),
        leds(start.commands("leds/*/color")) {}

  /// Sets the velocities of the tracks over ground [m/s].
  void drive(Command& command, double left, double right) const {
    command.set(left_track, left);
    command.set(right_track, right);
  }
  /// Turns to the left: runs the right track at `ahead + by` and the left track at `ahead - by` [m/s].
  void turn(Command& command, double ahead, double by) const { drive(command, ahead - by, ahead + by); }
  /// Turns the turret back to the front of the chassis, at a speed proportional to `angle`, the present angle of the
  /// turret relative to the chassis [rad]. If the turret cannot turn, for example because another robot grips it, the
  /// chassis turns.
  void turn_turret_back(Command& command, double angle) const { command.set(turret_motor, -turret_gain * angle); }
  /// Turns the turret back to the front of the chassis, by its measured angle.
  void align_turret(const Observation& observation, Command& command) const {
    turn_turret_back(command, observation[turret]);
  }
  /// Converts a bearing to the frame of the chassis. Returns an angle from -pi to pi [rad].
  double from_chassis(const Observation& observation, double bearing) const {
    return std::remainder(bearing + observation[turret], 2.0 * std::numbers::pi);
  }
  bool can_grip(const Observation& observation) const { return observation[grippable] > 0.5; }
  bool grips(const Observation& observation) const { return observation[gripping] > 0.5; }
  /// Closes the gripper. Call this in each step: the gripper opens in every step without this call.
  void close_gripper(Command& command) const { command.set(gripper, 0.0); }
  /// Emits a tone with the frequency `tone` [Hz] and the intensity `intensity` at 1 m [1].
  void call(Command& command, double tone, double intensity) const {
    command.set(frequency, tone);
    command.set(loudness, intensity);
  }
  void shine(Command& command, Color color) const {
    for (const CommandChannel led : leds) command.set(led, 1.0, static_cast<std::size_t>(color));
  }

  /// Returns the proximity of obstacles on the left and on the right. Each is the greatest weighted reading of the four
  /// sensors at 12, 36, 60 and 84 degrees from straight ahead on that side. Sensors that point sideways have lower
  /// weights.
  Sides obstacles(const Observation& observation) const {
    constexpr std::array weights{1.0, 0.8, 0.6, 0.3};
    Sides near;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      near.left = std::max(near.left, weights[i] * observation[proximity[i]]);
      near.right = std::max(near.right, weights[i] * observation[proximity[proximity.size() - 1 - i]]);
    }
    return near;
  }
  /// Returns the bearing of the light, from the vector sum of the light sensors, and their greatest reading.
  Light look(const Observation& observation) const {
    double ahead = 0.0, left = 0.0, brightest = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double reading = observation[light[i]];
      const double bearing = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(light.size());
      ahead += reading * std::cos(bearing);
      left += reading * std::sin(bearing);
      brightest = std::max(brightest, reading);
    }
    return {std::atan2(left, ahead), brightest};
  }
  /// Returns the sound at the microphones after inverting their saturation, 2 / (1 + exp(-x)) - 1.
  Sound listen(const Observation& observation) const {
    std::array<double, 4> heard{};
    for (std::size_t i = 0; i < heard.size(); ++i)
      heard[i] = -std::log(2.0 / (1.0 + std::min(observation[microphones[i]], 0.999999)) - 1.0);
    return {heard[0] + heard[3] - heard[1] - heard[2], heard[0] + heard[1] - heard[2] - heard[3],
            (heard[0] + heard[1] + heard[2] + heard[3]) / 4.0};
  }
  /// Returns true if the reading of any microphone is above `threshold`.
  bool hears(const Observation& observation, double threshold) const {
    return std::any_of(microphones.begin(), microphones.end(),
                       [&](ObservationChannel microphone) { return observation[microphone] > threshold; });
  }

  static constexpr double turret_gain = 5.0;  ///< [1/s]
  // Numbered counter-clockwise.
  std::vector<ObservationChannel> proximity;    ///< the first sensor is 12 degrees to the left of the gripper
  std::vector<ObservationChannel> ground;       ///< the first sensor is at the front
  std::vector<ObservationChannel> light;        ///< the first sensor points ahead
  std::vector<ObservationChannel> microphones;  ///< at the corners of a square; the first is at the front left
  ObservationChannel turret;                    ///< angle of the turret relative to the chassis [rad]
  ObservationChannel grippable;
  ObservationChannel gripping;
  CommandChannel left_track;
  CommandChannel right_track;
  CommandChannel turret_motor;
  CommandChannel gripper;
  CommandChannel frequency;  ///< frequency of the left speaker
  CommandChannel loudness;   ///< intensity of the left speaker
  std::vector<CommandChannel> leds;
};

}  // namespace cohort
