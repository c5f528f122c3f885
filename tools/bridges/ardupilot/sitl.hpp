// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/bridges/ardupilot/servo_packets.hpp"
#include "tools/bridges/common/firmware.hpp"

namespace cohort::ardupilot {

/// ArduPilot's SITL: each of its servo packets is answered at the next exchange.
class Sitl final : public bridges::Firmware {
 public:
  /// `patience` and `outputs` must outlive this. If `outputs` is empty, the outputs of the robot's model are used.
  Sitl(const bridges::Patience& patience, const std::vector<autopilots::Output>& outputs)
      : patience_(patience), given_(outputs) {}

  void start(const DrivenRobot& robot) override;
  bool exchange(bridges::Conversation& sitl, const Observation& observation) override;
  void act(Command& command) const override { outputs_.act(shares_, command); }
  void stand() override { shares_ = {}; }

 private:
  std::optional<ServoPacket> next_packet(bridges::Conversation& sitl);
  void answer(bridges::Conversation& sitl, const Observation& observation);
  bool is_answered(const ServoPacket& packet) const;
  void heed(bridges::Conversation& sitl, const ServoPacket& packet);

  const bridges::Patience& patience_;
  const std::vector<autopilots::Output>& given_;
  autopilots::OutputMap outputs_;
  autopilots::MotionSensors sensors_;
  double steps_in_a_second_ = 0.0;
  autopilots::Shares shares_{};
  bool driven_ = false;          // at some time
  bool is_silent_ = false;       // has exceeded the patience, and has sent nothing since
  bool owes_an_answer_ = false;  // to the packet of `frame_count_`
  std::uint32_t frame_count_ = 0;
  std::string last_answer_;
};

}  // namespace cohort::ardupilot
