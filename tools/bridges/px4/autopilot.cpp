// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/px4/autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/bridges/mavlink/payload.hpp"
#include "tools/bridges/px4/state_messages.hpp"

namespace cohort::px4 {
namespace {

constexpr std::uint64_t second = 1'000'000;  // [us]
constexpr std::uint64_t gps_interval = second / 10;
constexpr std::uint8_t own_system = 1;
constexpr std::uint8_t own_component = 200;
constexpr std::uint8_t no_autopilot = 8;             // MAV_AUTOPILOT_INVALID
constexpr std::uint16_t set_message_interval = 511;  // MAV_CMD_SET_MESSAGE_INTERVAL
constexpr std::size_t most_useless = 100'000;        // messages without controls in a row
constexpr int most_controls = 100;                   // at an exchange with what has a clock of its own

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

bool is_power_of_two(std::size_t count) { return (count & (count - 1)) == 0; }

}  // namespace

void Autopilot::start(const DrivenRobot& robot) {
  is_free_ = !robot.policy.waits;
  if (options_.is_hardware && !is_free_)
    throw std::runtime_error(
        "hardware runs in real time and cannot wait for a simulation in lockstep: set 'mode: free' for the team");
  period_ = static_cast<std::uint64_t>(std::llround(robot.start.seconds_per_step() * second));
  motion_.start(robot.start);
  magnetic_field_ = robot.start.observation("magnetometer/0/magnetic_field");
  pressure_ = robot.start.observation("barometer/0/pressure");
  outputs_.start(robot.start, options_.outputs, autopilots::Numbering::px4);
}

bool Autopilot::exchange(bridges::Conversation& px4, const Observation& observation) {
  if (is_free_) return exchange_freely(px4, observation);
  // The run stands still until PX4 has driven the robot for the first time.
  const bridges::Silence absence = driven_ ? patience_.silence : bridges::Silence::wait;
  for (;;) {
    if (!px4.wait_for_connection({absence})) return false;
    if (connection_ != px4.connections()) begin(px4);
    send_state(px4, observation);
    if (drives_ ? is_answered(px4) : boots_up(px4)) return true;
    if (drives_ && px4.is_connected()) {
      miss(px4);
      return patience_.silence == bridges::Silence::wait;
    }
    if (absence != bridges::Silence::wait) return false;
  }
}

// Controls that have not come yet are not waited for: those before them go on to act.
bool Autopilot::exchange_freely(bridges::Conversation& px4, const Observation& observation) {
  if (!px4.wait_for_connection({bridges::Silence::hold})) return false;
  if (connection_ != px4.connections()) begin(px4);
  using Microseconds = std::chrono::duration<std::uint64_t, std::micro>;
  time_ = 1 + std::chrono::duration_cast<Microseconds>(observation.time()).count();
  send_state(px4, observation);
  bool is_heard = false;
  for (int i = 0; i < most_controls; ++i) {
    const auto controls = next_controls(px4, Clock::now());
    if (!controls) break;
    heed(*controls);
    is_heard = true;
  }
  if (is_heard && !std::exchange(drives_, true)) px4.tell("drives the robot");
  if (is_heard) heard_at_ = Clock::now();
  const bool is_silent = !heard_at_ || Clock::now() - *heard_at_ > *patience_.at_most;
  if (heard_at_ && is_silent) {
    px4.tell("has stopped sending controls");
    heard_at_.reset();
    drives_ = false;
  }
  return patience_.silence == bridges::Silence::wait ? is_heard : !is_silent;
}

// Each connection is of a PX4 whose clock has not been set. Its time counts from 1 us: PX4 gives times since the first
// one that it was sent, or as they are, and the two differ by no more than that.
void Autopilot::begin(bridges::Conversation& px4) {
  connection_ = px4.connections();
  drives_ = false;
  time_ = 1;
  time_before_ = 0;
  state_interval_ = 0;
  heard_at_.reset();
  sequence_ = 0;
  broken_ = missed_ = 0;
}

// PX4's clock goes on with HIL_SENSOR, which is therefore the last one.
void Autopilot::send_state(bridges::Conversation& px4, const Observation& observation) {
  const autopilots::Motion motion = motion_.sense(observation);
  if (is_due(second)) {
    mavlink::Heartbeat heartbeat;
    heartbeat.autopilot = no_autopilot;
    send(px4, heartbeat);
  }
  if (is_due(gps_interval)) send(px4, gps_message(time_, motion, options_.home));
  if (state_interval_ > 0 && is_due(state_interval_)) send(px4, state_message(time_, motion, options_.home));
  send(px4, sensor_message(time_, motion, autopilots::to_frd(observation.values(magnetic_field_)),
                           observation[pressure_], options_.home));
  time_before_ = time_;
}

// Returns whether a multiple of the interval has passed since the HIL_SENSOR before.
bool Autopilot::is_due(std::uint64_t interval) const {
  return time_before_ == 0 || time_ / interval != time_before_ / interval;
}

template <class Message>
void Autopilot::send(bridges::Conversation& px4, const Message& message) {
  px4.send(mavlink::frame_of({sequence_++, own_system, own_component, Message::id, mavlink::payload_of(message)},
                             Message::crc_extra));
}

// At the pace of the wall clock, so that what PX4 waits for while it boots takes as long as elsewhere.
bool Autopilot::boots_up(bridges::Conversation& px4) {
  const auto controls = next_controls(px4, Clock::now() + std::chrono::microseconds(period_));
  time_ += period_;
  if (!controls) return false;
  px4.tell("drives the robot, " + std::to_string(time_ / 1000) + " ms after its clock has started");
  drives_ = true;
  driven_ = true;
  heed(*controls);
  return true;
}

bool Autopilot::is_answered(bridges::Conversation& px4) {
  const Clock::time_point deadline = Clock::now() + *patience_.at_most;
  const std::uint64_t expected = time_;
  while (const auto controls = next_controls(px4, deadline)) {
    if (controls->time_usec != expected && controls->time_usec + 1 != expected) continue;
    time_ += period_;
    heed(*controls);
    return true;
  }
  time_ += period_;
  return false;
}

void Autopilot::miss(bridges::Conversation& px4) {
  if (is_power_of_two(++missed_))
    px4.tell("has not answered HIL_SENSOR in time, " + counted(missed_, "time") +
             ": the run continues without its controls and is not reproducible (see --patience)");
}

std::optional<mavlink::HilActuatorControls> Autopilot::next_controls(bridges::Conversation& px4,
                                                                     Clock::time_point deadline) {
  for (std::size_t useless = 0; px4.is_connected(); ++useless) {
    if (useless > most_useless) {
      px4.hang_up("is disconnected: it sends messages continually, but no controls");
      break;
    }
    const auto left = std::max(Clock::duration::zero(), deadline - Clock::now());
    const auto bytes =
        px4.receive(mavlink::size_at, {bridges::Silence::hold, std::chrono::ceil<std::chrono::milliseconds>(left)});
    if (!bytes) break;
    const mavlink::Piece piece = mavlink::piece_of(*bytes);
    if (!piece.packet) count_broken(px4, bytes->size());
    if (!piece.packet || !piece.is_known) continue;
    if (const auto command = mavlink::message_in<mavlink::CommandLong>(*piece.packet)) heed(*command);
    if (auto controls = mavlink::message_in<mavlink::HilActuatorControls>(*piece.packet)) return controls;
  }
  return std::nullopt;
}

void Autopilot::heed(const mavlink::CommandLong& command) {
  const bool is_of_state =
      command.command == set_message_interval && command.parameters[0] == float{mavlink::HilStateQuaternion::id};
  if (!is_of_state) return;
  const float interval = command.parameters[1];
  if (interval == 0.0F)
    state_interval_ = period_;
  else
    state_interval_ = interval > 0.0F && interval < 1e9F ? static_cast<std::uint64_t>(interval) : 0;
}

void Autopilot::heed(const mavlink::HilActuatorControls& controls) {
  shares_ = {};
  for (const autopilots::Output& output : outputs_.outputs()) {
    if (output.number > controls.controls.size()) continue;
    const double control = controls.controls[output.number - 1];
    if (std::isnan(control)) continue;
    const bool is_reversible = output.low < 0.0;
    shares_[output.number - 1] = std::clamp(is_reversible ? (control + 1.0) / 2.0 : control, 0.0, 1.0);
  }
}

void Autopilot::count_broken(bridges::Conversation& px4, std::size_t bytes) {
  if (is_power_of_two(++broken_))
    px4.tell("has sent bytes that are not a valid MAVLink 2 message, " + counted(broken_, "time") + ", last " +
             counted(bytes, "byte") + ": skipped");
}

}  // namespace cohort::px4
