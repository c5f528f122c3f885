// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "cohort.h"  // made of idl/cohort.idl by fastddsgen

/// The topics of docs/protocol.md on Fast DDS for one client. Only this file uses Fast DDS.
namespace cohort::conformance {

namespace message = ::cohort::v1;

/// The DDS participant that wrote a message, by the prefix of its GUID: a server is one participant for each client.
using Participant = std::array<std::uint8_t, 12>;

template <class Message>
struct Received {
  Message message;
  Participant from{};
};

class Wire {
 public:
  /// Makes the readers, then the writers; does not wait for a server. Throws std::runtime_error if Fast DDS fails.
  Wire(std::uint32_t domain, std::uint64_t client);
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire();

  /// Returns when a message has arrived since the last call, or after `at_most`.
  void wait_for_news(std::chrono::milliseconds at_most);

  /// Returns the next message of a kind, if any. Call from one thread.
  std::optional<Received<message::Admit>> take_admit();
  std::optional<Received<message::RobotDescription>> take_description();
  std::optional<message::Observation> take_observation();
  std::optional<message::Report> take_report();
  std::optional<message::ControllerState> take_state();

  /// A message that cannot be written in time counts as lost.
  void write(message::Join join);
  void write(message::Command command);
  void write(message::Report report);
  void write(message::ControllerState state);
  /// Waits until the server has the report, but not for long.
  void wait_for_reports_to_arrive();

  /// Returns whether a writer for the Admit of this client has been discovered.
  bool sees_server() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::conformance
