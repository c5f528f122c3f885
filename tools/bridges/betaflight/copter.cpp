// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/copter.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/bridges/betaflight/program_link.hpp"

namespace cohort::betaflight {
namespace {

constexpr std::chrono::milliseconds sent_again_after{250};
constexpr std::chrono::milliseconds counts_as_pause{300};
constexpr std::chrono::seconds ready_within{20};  // it boots in 2 s, and on a machine with much other work in more
constexpr std::chrono::milliseconds at_once{0};
constexpr std::chrono::seconds boots_within{20};  // by its clock
constexpr std::chrono::seconds silence_told_after{2};
constexpr double velocity_smoothing = 0.1;  // [s]
constexpr double clock_nudge = 1e-4;        // [s], short beside a frame, even many times

// Turns a vector of the body into the axes of the earth.
Vector turned(const std::array<double, 4>& q, const Vector& v) {
  const auto [w, x, y, z] = q;
  const Vector t{2.0 * (y * v[2] - z * v[1]), 2.0 * (z * v[0] - x * v[2]), 2.0 * (x * v[1] - y * v[0])};
  return {v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
          v[2] + w * t[2] + x * t[1] - y * t[0]};
}

Vector vector_of(std::span<const double> values) { return {values[0], values[1], values[2]}; }

std::size_t servo_framing(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= servo_size) motors_in(bytes.first(servo_size));
  return servo_size;
}

Plan plan_of(const Start& start) {
  Plan plan;
  const std::vector<double> heights = start.parameters.reals("heights");
  if (!heights.empty()) plan.height = heights[start.robot % heights.size()];
  plan.take_off_at = start.parameters.real("take_off_at", plan.take_off_at);
  plan.land_at = start.parameters.real("land_at", std::numeric_limits<double>::max());
  return plan;
}

}  // namespace

Copter::Copter(const bridges::Patience& patience, std::unique_ptr<Program> program)
    : patience_(patience), program_(std::move(program)) {
  if (program_)
    program_->listen([this] { return conversation_ != nullptr && conversation_->is_given_up(); },
                     [this](const std::string& text) {
                       if (conversation_ != nullptr) conversation_->tell("has a problem: " + text);
                     });
}

Copter::Copter(const bridges::Patience& patience, std::string address)
    : patience_(patience), address_(std::move(address)) {}

void Copter::start(const DrivenRobot& robot) {
  const Start& start = robot.start;
  orientation_ = start.observation("imu/0/orientation");
  angular_velocity_ = start.observation("imu/0/angular_velocity");
  acceleration_ = start.observation("imu/0/linear_acceleration");
  pressure_ = start.observation("barometer/0/pressure");
  height_ = start.observation("altimeter/0/vertical_position");
  climb_ = start.observation("altimeter/0/vertical_velocity");
  pads_ = start.observation("camera/0/count");
  pad_ = start.observation("camera/0/position");
  const char* const names[] = {"rear_right", "front_right", "rear_left", "front_left"};
  for (std::size_t i = 0; i < rotors_.size(); ++i) rotors_[i] = start.command(std::string(names[i]) + "/0/velocity");
  pilot_.emplace(plan_of(start));
  step_ = start.seconds_per_step();
  place_ = velocity_ = {};
  motors_ = {};
  flies_ = false;
  sent_at_ = {};
  // A reset world has no past, so the program must not have one either.
  if (program_) program_->start();
}

bool Copter::exchange(bridges::Conversation& program, const Observation& observation) {
  State state = sense(observation);
  const Channels sticks = pilot_->fly(state, std::ranges::any_of(motors_, [](double m) { return m > 0.0; }), step_);
  if (state.time + time_lost_ < sent_) time_lost_ = sent_ + step_ - state.time;
  state.time += time_lost_;
  sent_ = state.time;
  conversation_ = &program;
  const bool has_virtual_time = program_ && program_->in_virtual_time() != nullptr;
  const std::optional<Motors> motors = has_virtual_time ? exchange_in_virtual_time(program, state, sticks)
                                                        : exchange_by_the_wall(program, state, sticks);
  if (motors) motors_ = *motors;
  if (motors && !std::exchange(flies_, true)) program.tell("flies the robot");
  return motors.has_value();
}

std::optional<Motors> Copter::exchange_by_the_wall(bridges::Conversation& program, State& state,
                                                   const Channels& sticks) {
  if (program_ && !flies_) wait_until_ready(program);
  if (!program_ && !flies_ && !wait_until_booted(program)) return std::nullopt;
  program.drop_received();  // earlier packets do not answer this one
  program.send(rc_packet(state.time, sticks));
  program.send(state_packet(state));
  // After half a second of silence the program uses a state for its clock alone, and forgets how long it was silent.
  // The next state would make that clock almost stop. Sending the same state once more is harmless, and corrects the
  // clock.
  const auto now = std::chrono::steady_clock::now();
  if (now - sent_at_ > counts_as_pause) {
    if (!wait_for_motors(program, state)) return std::nullopt;
    program.send(state_packet(state));
  }
  sent_at_ = std::chrono::steady_clock::now();
  return wait_for_motors(program, state);
}

// The program's clock is ahead of the packets' by what it took to boot. It gets sticks and state at the frame's time,
// each when it has come to rest, and then runs to the next frame, in which time it commands the motors.
std::optional<Motors> Copter::exchange_in_virtual_time(bridges::Conversation& program, const State& state,
                                                       const Channels& sticks) {
  exec::VirtualProgram& process = *program_->in_virtual_time();
  const auto expect = [&](bool runs) {
    if (runs) return;
    if (const auto how = program_->ended()) throw std::runtime_error("Betaflight " + *how);
    throw bridges::GaveUp{};
  };
  const auto received = [&] { return program.receive(servo_framing, {bridges::Silence::hold, at_once}); };
  const std::chrono::nanoseconds step =
      std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(step_));
  if (!flies_) {
    // It sends a first servo packet by itself when its loops begin. A state packet before would make it crash.
    while (!received()) {
      if (process.time() > boots_within)
        throw std::runtime_error("Betaflight has sent no servo packet in the first " +
                                 std::to_string(boots_within.count()) + " s of its clock");
      expect(process.run_now() && process.run_before(process.time() + step));
    }
    // The first state after a silence only sets its clock.
    program.send(state_packet(state));
    expect(process.run_now());
  }
  program.drop_received();
  program.send(rc_packet(state.time, sticks));
  expect(process.settle());
  program.send(state_packet(state));
  expect(process.run_now() && process.run_before(process.time() + step));
  std::optional<Motors> motors;
  while (const auto packet = received()) motors = motors_in(*packet);
  return motors;
}

// The program sends a first servo packet by itself, when its loops begin. Before, its sensors may not be there yet: a
// state packet would make it crash. On a machine with much other work, its loops may never begin. If the first pass
// comes later than two periods of the gyro, its scheduler waits for a time that has passed. Then it is started again.
void Copter::wait_until_ready(bridges::Conversation& program) {
  using Clock = std::chrono::steady_clock;
  auto patience = ready_within;
  Clock::time_point until = Clock::now() + patience;
  while (!program.receive(servo_framing, {bridges::Silence::hold, sent_again_after})) {
    if (const auto how = program_->ended()) throw std::runtime_error("Betaflight " + *how);
    if (Clock::now() < until) continue;
    program.tell("has sent no servo packet in " + std::to_string(patience.count()) + " s, and is started again");
    program_->start();
    patience *= 2;
    until = Clock::now() + patience;
  }
}

std::optional<Motors> Copter::wait_for_motors(bridges::Conversation& program, State& state) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  bool told = false;
  for (;;) {
    if (const auto packet = program.receive(servo_framing, {bridges::Silence::hold, asked_again_after()}))
      return motors_in(*packet);
    const auto waited = Clock::now() - began;
    if (!has_patience_after(waited)) return std::nullopt;
    if (!told && waited > silence_told_after) {
      program.tell("is silent: no servo packet answers the state packets" +
                   std::string(program_ ? "" : ". If it does not begin to, start it again"));
      told = true;
    }
    if (program_)
      if (const auto how = program_->ended()) throw std::runtime_error("Betaflight " + *how);
    // Datagrams may be lost. Or the program has been started again, and is still booting.
    if (program_ || has_booted(address_)) send_again(program, state);
  }
}

// The program's clock goes at the rate of simulated to real time between its last two packets. If a pause fell between
// them unnoticed, on a machine with much other work, that clock almost stands still, and the same state again would not
// change it. So the state comes a second time, at once, a little later by its own time: the clock then runs.
void Copter::send_again(bridges::Conversation& program, State& state) {
  program.send(state_packet(state));
  state.time += clock_nudge;
  time_lost_ += clock_nudge;
  sent_ = state.time;
  program.send(state_packet(state));
}

// A program that is still booting would crash at a state packet. Returns false when patience ends.
bool Copter::wait_until_booted(bridges::Conversation& program) const {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  while (!has_booted(address_)) {
    program.receive(servo_framing, {bridges::Silence::hold, asked_again_after()});
    if (!has_patience_after(Clock::now() - began)) return false;
  }
  return true;
}

bool Copter::has_patience_after(std::chrono::steady_clock::duration waited) const {
  return patience_.silence == bridges::Silence::wait || !patience_.at_most || waited < *patience_.at_most;
}

std::chrono::milliseconds Copter::asked_again_after() const {
  if (patience_.silence == bridges::Silence::wait) return sent_again_after;
  return std::min(sent_again_after, patience_.at_most.value_or(sent_again_after));
}

void Copter::act(Command& command) const {
  for (std::size_t i = 0; i < rotors_.size(); ++i)
    command.set(rotors_[i], std::max(motors_[i], 0.0) * rotors_[i].upper);
}

State Copter::sense(const Observation& observation) {
  State state;
  state.time = std::chrono::duration<double>(observation.time()).count();
  const auto q = observation.values(orientation_);
  state.orientation = {q[3], q[0], q[1], q[2]};
  state.angular_velocity = vector_of(observation.values(angular_velocity_));
  state.acceleration = vector_of(observation.values(acceleration_));
  state.pressure = observation[pressure_];
  state.position[2] = observation[height_];
  state.velocity[2] = observation[climb_];
  look_for_pad(observation, state);
  return state;
}

// The pad is the nearest thing that the camera sees. Its x axis points down, its z axis forward.
void Copter::look_for_pad(const Observation& observation, State& state) {
  const auto seen = observation.values(pad_);
  const double smoothing = step_ / (step_ + velocity_smoothing);
  const Vector pad = observation[pads_] > 0.5 ? turned(state.orientation, {seen[2], seen[1], -seen[0]})
                                              : Vector{-place_[0], -place_[1]};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double velocity = (-pad[axis] - place_[axis]) / step_;
    velocity_[axis] += (velocity - velocity_[axis]) * smoothing;
    state.position[axis] = place_[axis] = -pad[axis];
    state.velocity[axis] = velocity_[axis];
  }
}

}  // namespace cohort::betaflight
