// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cohort::test {

/// Stands in for Betaflight's SITL program: written from docs/bridges/betaflight.md alone, without code of the bridge.
/// It has an address of its own on this machine, 127.1.x.2, and so has its simulator, 127.1.x.1. Throws
/// std::runtime_error on any failure.
class BetaflightStandIn {
 public:
  explicit BetaflightStandIn(std::uint32_t number);
  BetaflightStandIn(const BetaflightStandIn&) = delete;
  BetaflightStandIn& operator=(const BetaflightStandIn&) = delete;
  ~BetaflightStandIn();

  std::string address() const { return prefix_ + "2"; }
  std::string simulator() const { return prefix_ + "1"; }

  /// Opens the command line, as the program does when it has booted. Before, connections to it are refused.
  void boot() const;
  /// Closes it, as a program that ends.
  void shut_down();
  /// Waits for the next state packet, 18 numbers; nothing if none comes within this.
  std::optional<std::array<double, 18>> receive_state(int milliseconds = 60'000) const;
  /// The channels of the last RC packet that has come.
  std::array<std::uint16_t, 16> receive_channels() const;
  void send(const std::vector<std::uint8_t>& datagram) const;
  /// A servo packet.
  void command(const std::array<float, 4>& motors) const;

 private:
  std::string prefix_;
  int state_ = -1;
  int channels_ = -1;
  int command_line_ = -1;
};

}  // namespace cohort::test
