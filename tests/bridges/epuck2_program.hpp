// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cohort::test {

using Bytes = std::vector<std::uint8_t>;

/// A program for an e-puck2, which connects to it over WiFi: written from docs/bridges/epuck2.md alone, without code of
/// the bridge. Throws std::runtime_error on any failure.
class EpuckProgram {
 public:
  explicit EpuckProgram(std::uint16_t port, const std::string& address = "127.0.0.1");
  EpuckProgram(EpuckProgram&& other) noexcept;
  EpuckProgram(const EpuckProgram&) = delete;
  EpuckProgram& operator=(const EpuckProgram&) = delete;
  ~EpuckProgram();

  static constexpr std::uint8_t nothing = 0;
  static constexpr std::uint8_t image = 1;
  static constexpr std::uint8_t sensors = 2;
  static Bytes command(int left, int right, std::uint8_t request = sensors);

  void send(const Bytes& bytes) const;
  /// So many bytes, or those that came before the robot hung up.
  Bytes receive(std::size_t count) const;
  /// The sensors packet without its id. Throws if another packet comes.
  Bytes receive_sensors() const;
  bool is_cut_off() const { return receive(1).empty(); }

 private:
  int socket_;
};

/// Fields of a sensors packet.
int signed_16(const Bytes& sensors, std::size_t place);
int unsigned_16(const Bytes& sensors, std::size_t place);
float real_32(const Bytes& sensors, std::size_t place);
std::array<int, 8> proximity(const Bytes& sensors);

/// Obstacle avoidance after Braitenberg: speeds of the left and right wheel [steps/s] from the proximity sensors.
std::array<int, 2> avoid_obstacles(const Bytes& sensors);

}  // namespace cohort::test
