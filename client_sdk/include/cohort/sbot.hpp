#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cohort/controller.hpp>
#include <numbers>
#include <vector>

namespace cohort {

/// The devices of an s-bot (docs/sbot.md). Its controllers make this in `start` and use it in `step`. Bearings are from
/// where the turret looks, counter-clockwise [rad].
struct Sbot {
  enum class Color : std::size_t { red, green, blue };
  struct Sides {
    double left = 0.0;
    double right = 0.0;
  };
  struct Light {
    double bearing = 0.0;
    double brightest = 0.0;  ///< of the sensors
  };
  struct Sound {
    double ahead = 0.0;  ///< by how much more arrives ahead than behind
    double left = 0.0;   ///< and on the left than on the right
    double level = 0.0;  ///< what arrives, the mean of the microphones

    double bearing() const { return std::atan2(left, ahead); }
  };

  Sbot() = default;
  /// Throws ChannelError if the robot is no s-bot.
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

  /// Speeds of the tracks over ground [m/s].
  void drive(Command& command, double left, double right) const {
    command.set(left_track, left);
    command.set(right_track, right);
  }
  /// To the left: the right track is `by` faster than `ahead`, the left one slower [m/s].
  void turn(Command& command, double ahead, double by) const { drive(command, ahead - by, ahead + by); }
  /// Turns the turret against the chassis until `angle` is gone, the faster the more there is of it. If the turret is
  /// held, the chassis turns.
  void turn_turret_back(Command& command, double angle) const { command.set(turret_motor, -turret_gain * angle); }
  /// Keeps the turret looking where the tracks go.
  void align_turret(const Observation& observation, Command& command) const {
    turn_turret_back(command, observation[turret]);
  }
  /// A bearing from where the tracks go, within half a turn.
  double from_chassis(const Observation& observation, double bearing) const {
    return std::remainder(bearing + observation[turret], 2.0 * std::numbers::pi);
  }
  bool can_grip(const Observation& observation) const { return observation[grippable] > 0.5; }
  bool grips(const Observation& observation) const { return observation[gripping] > 0.5; }
  /// The gripper is open in every step that does not close it.
  void close_gripper(Command& command) const { command.set(gripper, 0.0); }
  /// A tone [Hz], and what arrives of it at 1 m [1].
  void call(Command& command, double tone, double intensity) const {
    command.set(frequency, tone);
    command.set(loudness, intensity);
  }
  void shine(Command& command, Color color) const {
    for (const CommandChannel led : leds) command.set(led, 1.0, static_cast<std::size_t>(color));
  }

  /// How near obstacles are that are ahead: on each side the most of the four sensors at 12, 36, 60 and 84 degrees from
  /// straight ahead. What is beside the robot matters less than what is in its way.
  Sides obstacles(const Observation& observation) const {
    constexpr std::array weights{1.0, 0.8, 0.6, 0.3};
    Sides near;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      near.left = std::max(near.left, weights[i] * observation[proximity[i]]);
      near.right = std::max(near.right, weights[i] * observation[proximity[proximity.size() - 1 - i]]);
    }
    return near;
  }
  /// The direction of the sum of the light sensors.
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
  /// Undoes the saturation of the microphones, 2 / (1 + exp(-x)) - 1.
  Sound listen(const Observation& observation) const {
    std::array<double, 4> heard{};
    for (std::size_t i = 0; i < heard.size(); ++i)
      heard[i] = -std::log(2.0 / (1.0 + std::min(observation[microphones[i]], 0.999999)) - 1.0);
    return {heard[0] + heard[3] - heard[1] - heard[2], heard[0] + heard[1] - heard[2] - heard[3],
            (heard[0] + heard[1] + heard[2] + heard[3]) / 4.0};
  }
  /// Whether any of the microphones reads more than `threshold`.
  bool hears(const Observation& observation, double threshold) const {
    return std::any_of(microphones.begin(), microphones.end(),
                       [&](ObservationChannel microphone) { return observation[microphone] > threshold; });
  }

  static constexpr double turret_gain = 5.0;  ///< [1/s]
  // All are numbered counter-clockwise.
  std::vector<ObservationChannel> proximity;    ///< the first is 12 degrees to the left of the gripper
  std::vector<ObservationChannel> ground;       ///< the first is ahead
  std::vector<ObservationChannel> light;        ///< the first looks ahead
  std::vector<ObservationChannel> microphones;  ///< the corners of a square; the first is ahead and to the left
  ObservationChannel turret;                    ///< its angle to the chassis
  ObservationChannel grippable;
  ObservationChannel gripping;
  CommandChannel left_track;
  CommandChannel right_track;
  CommandChannel turret_motor;
  CommandChannel gripper;
  CommandChannel frequency;  ///< of the left speaker
  CommandChannel loudness;   ///< of the left speaker
  std::vector<CommandChannel> leds;
};

}  // namespace cohort
