// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "tools/bridges/common/firmware.hpp"
#include "tools/bridges/epuck2/packets.hpp"

namespace cohort::epuck2 {

/// The answer to a command that requests image and sensors.
enum class Packets {
  both,     ///< the image, then the sensors, as the robot sends them
  in_turn,  ///< one of them, alternately, for programs that read a single packet after each command
};

/// An e-puck2 driven by a program. Each command of the program is answered at the next exchange.
class Robot final : public bridges::Firmware {
 public:
  /// `patience` must outlive this.
  Robot(const bridges::Patience& patience, Packets packets) : patience_(patience), packets_(packets) {}

  /// Requires the channels of worlds/robots/epuck2.
  void start(const DrivenRobot& robot) override;
  bool exchange(bridges::Conversation& program, const Observation& observation) override;
  void act(cohort::Command& command) const override;
  void stand() override;

 private:
  Sensors sense(const Observation& observation) const;
  void answer(bridges::Conversation& program, const Observation& observation);
  void heed(const Command& received, const Observation& observation);
  std::array<std::int64_t, 2> steps_made(const Observation& observation) const;

  const bridges::Patience& patience_;
  Packets packets_;
  bool sent_image_ = false;      // with the last answer
  bool driven_ = false;          // by a program, at some time
  bool owes_an_answer_ = false;  // to `last_`
  Command last_;
  std::array<int, 2> speed_{};  // [steps/s]
  std::array<std::int64_t, 2> counters_begin_at_{};

  std::array<ObservationChannel, 2> wheel_position_;
  std::array<ObservationChannel, 8> proximity_;
  std::array<ObservationChannel, 3> ground_;
  ObservationChannel angular_velocity_;
  ObservationChannel acceleration_;
  ObservationChannel magnetic_field_;
  ObservationChannel distance_;
  std::array<CommandChannel, 2> wheel_velocity_;
  std::array<CommandChannel, 8> leds_;
  CommandChannel body_led_;
  CommandChannel front_led_;
};

}  // namespace cohort::epuck2
