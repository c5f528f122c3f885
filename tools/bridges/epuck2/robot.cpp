// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/epuck2/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>

namespace cohort::epuck2 {
namespace {

// docs/bridges/epuck2.md has the source of each of these.
constexpr double steps_in_a_turn = 1000.0;
constexpr int fastest = 1100;  // [steps/s]
constexpr double standard_gravity = 9.80665;
constexpr double counts_of_one_g = 768.0;
constexpr double counts_of_one_degree_per_second = 131.0;
constexpr double proximity_range = 0.12;      // [m], of the model's rings
constexpr double greatest_distance = 2000.0;  // [mm], of the distance sensor
constexpr double ground_in_contact = 1000.0;
constexpr std::int8_t room_temperature = 25;
constexpr std::uint16_t dim_light = 4000;
constexpr std::uint16_t full_battery = 3440;
constexpr std::uint8_t selector_of_wifi = 15;

constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

template <class Integer>
Integer counts(double value) {
  return static_cast<Integer>(
      std::lround(std::clamp<double>(value, std::numeric_limits<Integer>::min(), std::numeric_limits<Integer>::max())));
}

// Returns a sensor's count for a wall at a distance [m], as in Enki's model of the e-puck.
double reflected(double distance) {
  const double cm = 100.0 * distance;
  return cm < 0.5 ? 2965.98144 - 440.0 * cm : 4526.0 * std::exp(-0.9994 * cm);
}

// As the firmware computes them from the counts.
void fill_spherical(Sensors& sensors) {
  const double x = sensors.acceleration[0], y = sensors.acceleration[1], z = sensors.acceleration[2];
  const double inclination = 90.0 - degrees(std::atan2(z, std::sqrt(x * x + y * y)));
  const bool has_direction = inclination >= 5.0 && inclination <= 160.0;
  sensors.acceleration_size = static_cast<float>(std::sqrt(x * x + y * y + z * z));
  sensors.inclination = static_cast<float>(inclination);
  sensors.orientation = has_direction ? static_cast<float>(degrees(std::atan2(x, y)) + 180.0) : 0.0F;
}

void set_color(cohort::Command& command, CommandChannel led, double red, double green, double blue) {
  command.set(led, red, 0);
  command.set(led, green, 1);
  command.set(led, blue, 2);
}

std::size_t command_framing(std::span<const std::uint8_t> bytes) {
  if (const auto mistake = mistake_of(bytes.first(std::min(bytes.size(), command_size))))
    throw std::runtime_error(*mistake);
  return command_size;
}

}  // namespace

void Robot::start(const DrivenRobot& robot) {
  const Start& start = robot.start;
  wheel_position_ = {start.observation("left_wheel/0/position"), start.observation("right_wheel/0/position")};
  wheel_velocity_ = {start.command("left_wheel/0/velocity"), start.command("right_wheel/0/velocity")};
  for (std::size_t i = 0; i < proximity_.size(); ++i) {
    proximity_[i] = start.observation("prox_" + std::to_string(i) + "/0/reading");
  }
  for (std::size_t i = 0; i < ground_.size(); ++i) {
    ground_[i] = start.observation("ground/" + std::to_string(i) + "/reading");
  }
  angular_velocity_ = start.observation("imu/0/angular_velocity");
  acceleration_ = start.observation("imu/0/linear_acceleration");
  magnetic_field_ = start.observation("magnetometer/0/magnetic_field");
  distance_ = start.observation("tof/0/ranges");
  // The robot's LEDs are numbered clockwise, the ring's counter-clockwise, both from the front.
  for (std::size_t i = 0; i < leds_.size(); ++i) {
    leds_[i] = start.command("leds/" + std::to_string((leds_.size() - i) % leds_.size()) + "/color");
  }
  body_led_ = start.command("body_led/0/color");
  front_led_ = start.command("front_led/0/color");
  counters_begin_at_ = {};
}

bool Robot::exchange(bridges::Conversation& program, const Observation& observation) {
  if (owes_an_answer_) answer(program, observation);
  owes_an_answer_ = false;
  // Time stands still until a program has driven the robot for the first time, unless the bridge has started it.
  const bool is_under_way = driven_ || program.has_started_program();
  const auto received = program.receive(command_framing, is_under_way ? patience_ : bridges::Patience{});
  if (!received) return false;
  driven_ = true;
  owes_an_answer_ = true;
  heed(decode(*received), observation);
  return true;
}

void Robot::stand() {
  last_ = {};
  speed_ = {};
}

void Robot::answer(bridges::Conversation& program, const Observation& observation) {
  const bool one_of_two = packets_ == Packets::in_turn && last_.wants_image && last_.wants_sensors;
  const bool sends_image = last_.wants_image && !(one_of_two && sent_image_);
  const bool sends_sensors = last_.wants_sensors && !(one_of_two && sends_image);
  sent_image_ = sends_image;
  if (sends_image) program.send(image_packet());
  if (sends_sensors) program.send(sensors_packet(sense(observation)));
  if (!sends_image && !sends_sensors) program.send(empty_packet());
}

void Robot::heed(const Command& received, const Observation& observation) {
  const auto colors_before = last_.rgb_leds;
  last_ = received;
  for (std::size_t led = 0; led < last_.rgb_leds.size(); ++led) {
    const bool in_range = std::ranges::all_of(last_.rgb_leds[led], [](int c) { return c <= greatest_brightness; });
    if (!in_range) last_.rgb_leds[led] = colors_before[led];
  }
  const std::array<int, 2> wanted{received.left, received.right};
  if (received.sets_steps) {
    const auto made = steps_made(observation);
    for (std::size_t side = 0; side < made.size(); ++side) counters_begin_at_[side] = made[side] - wanted[side];
  } else {
    for (std::size_t side = 0; side < wanted.size(); ++side) speed_[side] = std::clamp(wanted[side], -fastest, fastest);
  }
}

void Robot::act(cohort::Command& command) const {
  for (std::size_t side = 0; side < speed_.size(); ++side) {
    command.set(wheel_velocity_[side], speed_[side] * 2.0 * std::numbers::pi / steps_in_a_turn);
  }
  for (std::size_t i = 0; i < last_.red_leds.size(); ++i) {
    set_color(command, leds_[2 * i], last_.red_leds[i] ? 1.0 : 0.0, 0.0, 0.0);
  }
  for (std::size_t i = 0; i < last_.rgb_leds.size(); ++i) {
    const auto share = [&](std::size_t color) { return last_.rgb_leds[i][color] / double{greatest_brightness}; };
    set_color(command, leds_[2 * i + 1], share(0), share(1), share(2));
  }
  set_color(command, body_led_, 0.0, last_.body_led ? 1.0 : 0.0, 0.0);
  set_color(command, front_led_, last_.front_led ? 1.0 : 0.0, 0.0, 0.0);
}

std::array<std::int64_t, 2> Robot::steps_made(const Observation& observation) const {
  const auto steps = [&](ObservationChannel wheel) {
    return std::int64_t{std::llround(observation[wheel] * steps_in_a_turn / (2.0 * std::numbers::pi))};
  };
  return {steps(wheel_position_[0]), steps(wheel_position_[1])};
}

Sensors Robot::sense(const Observation& observation) const {
  Sensors sensors;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sensors.acceleration[axis] =
        counts<std::int16_t>(observation.values(acceleration_)[axis] / standard_gravity * counts_of_one_g);
    sensors.angular_velocity[axis] =
        counts<std::int16_t>(degrees(observation.values(angular_velocity_)[axis]) * counts_of_one_degree_per_second);
    sensors.magnetic_field[axis] = static_cast<float>(1e6 * observation.values(magnetic_field_)[axis]);
    sensors.ground[axis] = counts<std::uint16_t>(ground_in_contact * observation[ground_[axis]]);
  }
  fill_spherical(sensors);
  sensors.temperature = room_temperature;
  for (std::size_t i = 0; i < proximity_.size(); ++i) {
    const double reading = observation[proximity_[i]];
    sensors.proximity[i] =
        reading > 0.0 ? counts<std::uint16_t>(reflected((1.0 - reading) * proximity_range)) : std::uint16_t{0};
  }
  sensors.ambient_light.fill(dim_light);
  sensors.distance = counts<std::uint16_t>(std::min(1000.0 * observation[distance_], greatest_distance));
  const auto made = steps_made(observation);
  for (std::size_t side = 0; side < made.size(); ++side) {
    sensors.steps[side] = static_cast<std::int16_t>(made[side] - counters_begin_at_[side]);
  }
  sensors.battery = full_battery;
  sensors.selector = selector_of_wifi;
  return sensors;
}

}  // namespace cohort::epuck2
