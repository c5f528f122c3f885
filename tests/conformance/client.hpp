// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/conformance/frames.hpp"
#include "tests/conformance/robots.hpp"
#include "tests/conformance/states.hpp"
#include "tests/conformance/wire.hpp"

namespace cohort::conformance {

struct Options {
  std::uint32_t domain = 0;
  std::vector<std::string> robots{};
  std::string plugin{};  ///< the controller's
  /// Simulates a bad network: one of so many received frames is dropped, and as many answers, when they are first sent;
  /// 0 for none.
  std::uint64_t loses_every = 0;
};

enum class End { finished, refused, superseded, failed, server_lost };

/// A client as described in docs/protocol.md, from Join to its end. Prints its events to standard output.
class Client {
 public:
  explicit Client(Options options);
  End run();

 private:
  void join_every_second();
  void take_reports();
  void take_admits();
  void begin_when_described();
  void take_frames();
  void take_frame(message::Observation frame);
  void answer_frames();
  void take_states();
  void look_for_server();
  void fail(const std::string& why);

  Options options_;
  std::uint64_t id_;
  Wire wire_;
  Robots robots_;
  // Descriptions of each server; a replacement server is another participant.
  std::map<Participant, std::map<std::uint32_t, message::RobotDescription>> descriptions_;
  std::optional<Received<message::Admit>> offered_;  // waits for its descriptions
  std::optional<message::Admit> admitted_;
  Participant server_{};                 // that has admitted it
  std::optional<FetchedState> fetched_;  // without which no frame is answered
  std::uint64_t answered_up_to_ = 0;     // ticks of the lease before it
  std::vector<std::uint8_t> saved_;
  std::optional<std::uint64_t> saved_tick_;
  std::optional<Frames> frames_;
  std::vector<message::Observation> early_;  // frames whose Admit has not come
  std::optional<std::chrono::steady_clock::time_point> joined_at_;
  std::optional<std::chrono::steady_clock::time_point> without_server_since_;
  std::uint64_t frames_seen_ = 0;
  std::uint64_t answers_given_ = 0;
  std::uint64_t answers_repeated_ = 0;
  std::optional<End> end_;
};

}  // namespace cohort::conformance
