// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/bridges/autopilots/autopilot_outputs.hpp"
#include "tools/bridges/autopilots/vehicle_motion.hpp"
#include "tools/bridges/common/firmware.hpp"
#include "tools/bridges/mavlink/hil_messages.hpp"

namespace cohort::px4 {

/// PX4, connected as to its simulator: it receives the measurements of its sensors and answers with controls.
///
/// PX4 boots on simulated time. Before it sends its first controls, it receives the present measurements at the pace of
/// the wall clock, while the simulation stands still. After that, each exchange sends the measurements once, and waits
/// for the controls of the same time.
///
/// If PX4 drives a robot of a free team, it runs on its own clock: each exchange sends the measurements and uses the
/// latest controls received.
class Autopilot final : public bridges::Firmware {
 public:
  struct Options {
    autopilots::Geodetic home{47.397742, 8.545594, 488.0};  ///< position of the world's origin; PX4's default
    std::vector<autopilots::Output> outputs{};              ///< empty: those of the robot's model
    bool is_hardware = false;                               ///< has a clock of its own
  };
  /// `patience` and `options` must outlive this.
  Autopilot(const bridges::Patience& patience, const Options& options) : patience_(patience), options_(options) {}

  void start(const DrivenRobot& robot) override;
  bool exchange(bridges::Conversation& px4, const Observation& observation) override;
  void act(Command& command) const override { outputs_.act(shares_, command); }
  void stand() override { shares_ = {}; }

 private:
  using Clock = std::chrono::steady_clock;

  bool exchange_freely(bridges::Conversation& px4, const Observation& observation);
  void begin(bridges::Conversation& px4);
  void send_state(bridges::Conversation& px4, const Observation& observation);
  bool is_due(std::uint64_t interval) const;
  bool boots_up(bridges::Conversation& px4);
  bool is_answered(bridges::Conversation& px4);
  void miss(bridges::Conversation& px4);
  std::optional<mavlink::HilActuatorControls> next_controls(bridges::Conversation& px4, Clock::time_point deadline);
  void heed(const mavlink::CommandLong& command);
  void heed(const mavlink::HilActuatorControls& controls);
  void count_broken(bridges::Conversation& px4, std::size_t bytes);
  template <class Message>
  void send(bridges::Conversation& px4, const Message& message);

  const bridges::Patience& patience_;
  const Options& options_;
  autopilots::OutputMap outputs_;
  autopilots::MotionSensors motion_;
  ObservationChannel magnetic_field_;
  ObservationChannel pressure_;
  std::uint64_t period_ = 0;  // [us]
  bool is_free_ = false;      // the robot's team is free
  autopilots::Shares shares_{};
  bool driven_ = false;  // at some time

  // State of the present connection.
  std::size_t connection_ = 0;        // its number, from 1
  bool drives_ = false;               // controls have been received
  std::uint64_t time_ = 0;            // time of the last HIL_SENSOR [us]
  std::uint64_t time_before_ = 0;     // time of the HIL_SENSOR before it; 0: none
  std::uint64_t state_interval_ = 0;  // interval of HIL_STATE_QUATERNION [us]; 0: not requested
  std::uint8_t sequence_ = 0;
  std::size_t broken_ = 0;  // pieces that were no messages
  std::size_t missed_ = 0;  // exchanges without controls in time
  std::optional<Clock::time_point>
      heard_at_{};  // arrival of the last controls, in a free team; nullopt once the silence was reported
};

}  // namespace cohort::px4
