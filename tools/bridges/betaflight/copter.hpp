// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "tools/bridges/betaflight/pilot.hpp"
#include "tools/bridges/betaflight/sitl_packets.hpp"
#include "tools/bridges/betaflight/sitl_program.hpp"
#include "tools/bridges/common/firmware.hpp"

namespace cohort::betaflight {

/// A quadcopter flown by Betaflight, which follows the sticks of a pilot. At each frame Betaflight gets the state and
/// the sticks, and sends one command to the motors.
class Copter final : public bridges::Firmware {
 public:
  /// `patience` must outlive this. `program` is started and ended with the run.
  Copter(const bridges::Patience& patience, std::unique_ptr<Program> program);
  /// Uses a program that is started outside of the bridge, at this IPv4 address.
  Copter(const bridges::Patience& patience, std::string address);

  /// Requires the channels of worlds/robots/quadcopter_x.
  void start(const DrivenRobot& robot) override;
  bool exchange(bridges::Conversation& program, const Observation& observation) override;
  void act(Command& command) const override;
  void stand() override { motors_ = {}; }

 private:
  State sense(const Observation& observation);
  void look_for_pad(const Observation& observation, State& state);
  void wait_until_ready(bridges::Conversation& program);
  bool wait_until_booted(bridges::Conversation& program) const;
  std::chrono::milliseconds asked_again_after() const;
  bool has_patience_after(std::chrono::steady_clock::duration waited) const;
  std::optional<Motors> exchange_by_the_wall(bridges::Conversation& program, State& state, const Channels& sticks);
  std::optional<Motors> exchange_in_virtual_time(bridges::Conversation& program, const State& state,
                                                 const Channels& sticks);
  std::optional<Motors> wait_for_motors(bridges::Conversation& program, State& state);
  void send_again(bridges::Conversation& program, State& state);

  const bridges::Patience& patience_;
  std::unique_ptr<Program> program_;                     // null if it is started outside of the bridge,
  std::string address_;                                  // at this address
  const bridges::Conversation* conversation_ = nullptr;  // from the first exchange on
  std::optional<Pilot> pilot_;
  double step_ = 0.0;   // between frames [s]
  double sent_ = -1.0;  // time of the last state packet [s]
  // Offset of the packets' time from the run's time [s]. Grows at resets, which must not turn the packets' time back,
  // and with packets that are sent again.
  double time_lost_ = 0.0;
  std::array<double, 2> place_{}, velocity_{};  // north and west of the pad, when it was last seen
  Motors motors_{};
  std::chrono::steady_clock::time_point sent_at_{};  // by the wall clock
  bool flies_ = false;                               // the program has answered since the start

  ObservationChannel orientation_, angular_velocity_, acceleration_, pressure_, height_, climb_, pads_, pad_;
  std::array<CommandChannel, 4> rotors_;
};

}  // namespace cohort::betaflight
