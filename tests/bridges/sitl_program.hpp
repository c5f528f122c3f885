// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/bridges/pilots.hpp"

namespace cohort::test {

/// ArduPilot's SITL as its simulator sees it: it sends its servo packet and blocks until an answer comes, sending the
/// packet again after each second without one. Written from docs/bridges/ardupilot.md alone.
class SitlProgram {
 public:
  explicit SitlProgram(std::uint16_t port);
  SitlProgram(const SitlProgram&) = delete;
  SitlProgram& operator=(const SitlProgram&) = delete;
  ~SitlProgram();

  static std::vector<std::uint8_t> packet(std::uint32_t frame_count, const Outputs& outputs, bool has_32 = false);

  void send(const std::vector<std::uint8_t>& datagram) const;
  /// An answer that is there within `milliseconds`.
  std::optional<std::string> receive(int milliseconds) const;
  /// Does one step: packet and answer. Returns false if the other side has ended.
  bool step(Pilot pilot);
  /// Steps until the other side has ended, or so many times.
  int fly(Pilot pilot, int at_most = 1'000'000);

  Seen seen;
  std::string last_answer;
  std::uint32_t frame_count = 0;
  int resent = 0;
  bool has_32 = false;
  /// [s] A packet of the last step of the run has no answer: from there on it is not waited for.
  double run_ends_at = 1e9;

 private:
  int socket_;
  mutable bool refused_ = false;
};

}  // namespace cohort::test
