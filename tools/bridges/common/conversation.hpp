// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/bridges/common/gave_up.hpp"
#include "tools/bridges/common/link.hpp"
#include "tools/bridges/common/timed_program.hpp"

namespace cohort::bridges {

/// The reaction to firmware that is not connected or does not answer in time.
enum class Silence {
  wait,   ///< the frame is not answered before the firmware has sent: the run waits as long as its team allows
  stand,  ///< the robot gets its neutral command
  hold,   ///< the robot keeps its last command
};

/// How long a bridge waits for firmware.
struct Patience {
  Silence silence = Silence::wait;
  /// Wall time that connected firmware may take for one message, unless `silence` is `wait`; nullopt: no limit.
  std::optional<std::chrono::milliseconds> at_most{};
};

/// Messages to and from one robot's firmware. Unlike a Link, it waits for them. An invalid message from the firmware
/// ends the connection and is reported to the user. Not thread-safe.
class Conversation {
 public:
  struct Callbacks {
    std::function<bool()> given_up;                     ///< asked several times a second while it waits
    std::function<void(const std::string& text)> tell;  ///< reports connections, disconnections and their reasons
  };
  /// `who` is the word for the other side in messages to the user, such as `firmware`.
  Conversation(std::unique_ptr<Link> link, std::string who, Callbacks callbacks);

  std::string place() const { return link_->place(); }

  /// Sets the program at the other side; nullptr: none was started by the bridge. While the program runs, the functions
  /// below wait in its virtual time. It counts as silent if it has sent nothing by the end of the frame, and continues
  /// in the next frame.
  void goes_by_time_of(TimedProgram* program) { program_ = program; }
  /// Returns whether the bridge has started the program, though it may have ended.
  bool has_started_program() const { return program_ != nullptr; }
  bool is_in_virtual_time() const { return program_ != nullptr && program_->runs(); }

  /// Returns the size of the message that `bytes` start with [bytes], or 0 if the message or its size is incomplete.
  /// Throws std::runtime_error that says why the bytes cannot be the start of a message.
  using Framing = std::function<std::size_t(std::span<const std::uint8_t> bytes)>;

  /// Returns the next message; nullopt if the firmware is silent or disconnected for longer than `patience` allows. In
  /// real time, a call that does not wait and loses the connection returns nullopt, and only the next call accepts a
  /// new connection. Throws GaveUp when the message is no longer wanted.
  std::optional<std::vector<std::uint8_t>> receive(const Framing& framing, const Patience& patience);

  /// Waits until firmware is connected. Returns false if none is connected and `patience` does not allow to wait.
  /// Throws GaveUp.
  bool wait_for_connection(const Patience& patience);

  /// Returns the number of connections so far, including the present one.
  std::size_t connections() const { return connections_; }
  bool is_connected() const { return is_connected_; }

  /// Sends a message to the connected firmware; does nothing without a connection. A program in virtual time that does
  /// not read the message now receives it before its next message is received. Throws GaveUp.
  void send(std::span<const std::uint8_t> message);

  /// Drops incoming data that `receive` has not returned: answers to earlier messages.
  void drop_received();

  /// Returns whether the firmware's answer is no longer wanted. Code that waits for the answer in another way must
  /// check this several times a second.
  bool is_given_up() const { return callbacks_.given_up(); }

  /// Reports `the firmware TEXT` to the user.
  void tell(const std::string& text) const { callbacks_.tell("the " + who_ + " " + text); }

  /// Ends the connection and reports the reason to the user, as `the firmware WHY`.
  void hang_up(const std::string& why);

  /// Ends the connection for good, without a report.
  void leave() { link_->hang_up(); }

  /// Limit of a message's size [bytes].
  static constexpr std::size_t largest_message = 65536;
  /// Limit of the number of messages that a program in virtual time has not read.
  static constexpr std::size_t most_unsent = 1000;

 private:
  bool connect();
  bool read_more();
  bool write(std::span<const std::uint8_t>& message);
  void send_in_virtual_time(std::span<const std::uint8_t> message);
  bool has_sent_all();
  std::optional<std::vector<std::uint8_t>> receive_in_virtual_time(const Framing& framing);
  std::optional<std::vector<std::uint8_t>> take(const Framing& framing);
  void wait_for(short event, std::chrono::steady_clock::time_point until) const;

  std::unique_ptr<Link> link_;
  std::string who_;
  Callbacks callbacks_;
  bool is_connected_;
  std::size_t connections_ = 0;
  std::size_t expected_size_ = 0;       // size of the incoming message; 0 while unknown
  std::vector<std::uint8_t> received_;  // and not returned by receive() yet
  TimedProgram* program_ = nullptr;
  std::deque<std::vector<std::uint8_t>> unsent_;  // messages that the program has not read
};

}  // namespace cohort::bridges
