// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/avr_robot.hpp"

#include <array>
#include <cstdio>
#include <utility>

namespace cohort::avr {
namespace {

constexpr std::uint64_t second = 1'000'000'000;
constexpr std::size_t longest_line = 200;
constexpr std::size_t most_lines = 1000;  // in one step
constexpr int most_notes_told = 10;
constexpr std::size_t largest_input = 64;  // in one step [bytes]

}  // namespace

std::uint64_t cycles_in(std::chrono::nanoseconds time, std::uint32_t frequency) {
  const auto whole = static_cast<std::uint64_t>(time.count());
  return whole / second * frequency + whole % second * frequency / second;
}

Robot::Robot(const Options& options, std::unique_ptr<Board> board, const DrivenRobot& robot,
             std::shared_ptr<bridges::Link> pty)
    : options_(options),
      pty_(std::move(pty)),
      core_(options_.image, options_.chip),
      board_(std::move(board)),
      period_(robot.start.step * robot.policy.period) {
  board_->start(robot.start, core_);
  connect_serial();
}

void Robot::connect_serial() {
  if (options_.serial_to == SerialTo::none) return;
  core_.connect_serial(options_.serial, [this](std::uint8_t byte) { receive(byte); });
}

std::uint64_t Robot::cycle_at(std::chrono::nanoseconds time) const {
  return time > *switched_on_ ? cycles_in(time - *switched_on_, options_.chip.frequency) : 0;
}

void Robot::step(FrameRobot& frame, std::chrono::nanoseconds time) {
  begin(frame, time);
  run_until(time + period_);
  end(frame);
}

void Robot::begin(const FrameRobot& frame, std::chrono::nanoseconds time) {
  if (!switched_on_) {
    switched_on_ = time + options_.power_on;
    board_->switch_on(*switched_on_);
  }
  feed_serial();
  core_.outputs().begin_window();
  board_->sense(frame.observation, core_.cycle(), cycle_at(time + period_));
}

void Robot::run_until(std::chrono::nanoseconds time) { core_.run_until(cycle_at(time)); }

void Robot::end(FrameRobot& frame) {
  // A core that has crashed drives nothing: the robot gets its neutral command.
  if (!core_.fault()) board_->act(frame.command);
  tell_of_the_core(frame.observation.tick());
}

void Robot::tell_of_the_core(std::uint64_t tick) {
  const std::string at = "tick " + std::to_string(tick) + ": the microcontroller ";
  for (const std::string& note : core_.take_notes()) {
    if (++notes_told_ < most_notes_told) tell(at + note);
    if (notes_told_ == most_notes_told) tell(at + note + ". Further notes of this robot are not shown");
  }
  if (core_.fault() && !std::exchange(told_of_fault_, true))
    tell(at + "has crashed: " + *core_.fault() + ". Its robot gets neutral commands from now on");
}

void Robot::receive(std::uint8_t byte) {
  if (pty_) {
    // Bytes without a reader are lost, as on a serial line.
    try {
      pty_->write({&byte, 1});
    } catch (const bridges::LinkLost&) {
    }
    return;
  }
  if (byte == '\r') return;
  if (byte != '\n') line_ += byte >= ' ' && byte < 127 ? static_cast<char>(byte) : '.';
  if (byte != '\n' && line_.size() < longest_line) return;
  std::array<char, 32> time{};
  const double seconds = static_cast<double>(core_.cycle()) / options_.chip.frequency;
  std::snprintf(time.data(), time.size(), "%.3f s: ", seconds);
  if (lines_.size() < most_lines) tell(time.data() + std::exchange(line_, {}));
  line_.clear();
}

void Robot::feed_serial() {
  if (!pty_) return;
  if (sent_to_it_.empty()) {
    sent_to_it_.resize(largest_input);
    try {
      sent_to_it_.resize(pty_->read(sent_to_it_));
    } catch (const bridges::LinkLost&) {
      sent_to_it_.clear();
    }
  }
  const std::size_t taken = core_.send_serial(options_.serial, sent_to_it_);
  sent_to_it_.erase(sent_to_it_.begin(), sent_to_it_.begin() + static_cast<std::ptrdiff_t>(taken));
}

std::vector<std::string> Robot::take_lines() { return std::exchange(lines_, {}); }

}  // namespace cohort::avr
