// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "tools/bridges/avr/core.hpp"
#include "tools/bridges/avr/medium.hpp"

/// The infrared light by which Kilobots send messages to their neighbours (docs/bridges/kilobot.md).
namespace cohort::avr::kilobot {

class Air;

/// Outputs of a receiver's two amplifiers, as counts of the 10-bit analog-to-digital converter.
struct Gains {
  int low = 0, high = 0;
};
/// Returns the outputs for the light of a robot at this distance between the robots' centres [m].
Gains gains_at(double distance);

/// A robot whose light is received, and its distance [m].
struct Heard {
  std::uint32_t robot = 0;
  double distance = 0.0;
};

/// The infrared transmitter and receiver of one robot, on the pins of its core. Used by the thread that runs the core.
class Transceiver {
 public:
  /// Connects to a core that has not run yet.
  Transceiver(Air& air, std::uint32_t robot, Core& core);
  Transceiver(const Transceiver&) = delete;
  Transceiver& operator=(const Transceiver&) = delete;
  ~Transceiver();

  /// Sets the simulated time of the core's cycle 0.
  void switch_on(std::chrono::nanoseconds time) { switched_on_ = time; }

  /// Sets the robots whose light is received from now on.
  void hear(std::vector<Heard> senders) { senders_ = std::move(senders); }

  /// Delivers a message of 12 bytes with the signal strength of a touching robot. Its first pulse begins at this cycle
  /// of the nominal clock.
  void receive_message(std::uint64_t cycle, std::span<const std::uint8_t> message);

 private:
  friend class Air;
  struct Edge {
    std::chrono::nanoseconds time;
    bool lit;
  };

  void on_pin(unsigned pin, std::uint64_t cycle, bool high);
  void pass(std::uint32_t sender, const Edge& edge);
  void light(bool lit, std::int32_t strength);
  void darken(std::uint64_t pulse);
  static void on_comparator(avr_irq_t* irq, std::uint32_t value, void* transceiver);

  Air& air_;
  std::uint32_t robot_;
  Core& core_;
  avr_irq_t* comparator_ = nullptr;
  avr_irq_t* trigger_ = nullptr;
  std::chrono::nanoseconds switched_on_{0};
  unsigned pins_lit_ = 0;
  std::vector<Edge> sent_;  // since the last exchange
  std::vector<Heard> senders_;
  std::map<std::uint32_t, std::int32_t> passing_;  // strengths of the pulses that have not ended, by sender
  int pulses_ = 0;                                 // being received
  std::int32_t strength_ = 0;                      // sum over all of them
  std::uint64_t last_pulse_ = 0;
};

/// The infrared light between robots. Receivers in range get a signal one bit time later, with each edge at its exact
/// cycle.
class Air final : public Medium {
 public:
  std::chrono::nanoseconds window() const override;
  void exchange() override;

 private:
  friend class Transceiver;
  std::map<std::uint32_t, Transceiver*> transceivers_;  // by robot
};

}  // namespace cohort::avr::kilobot
