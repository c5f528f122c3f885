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
  wait,  ///< the frame is not answered until the firmware has spoken: the run waits as long as its team's policy allows
  stand,  ///< the robot gets its neutral command
  hold,   ///< the robot keeps its last command
};

/// How long a bridge waits for firmware.
struct Patience {
  Silence silence = Silence::wait;
  /// Wall time that connected firmware may take for one message, unless `silence` is `wait`. Without it: for ever.
  std::optional<std::chrono::milliseconds> at_most{};
};

/// Messages to and from one robot's firmware. Waits where a Link does not. An invalid message of the firmware ends its
/// connection and is reported to the user. One thread.
class Conversation {
 public:
  struct Callbacks {
    std::function<bool()> given_up;                     ///< asked while it waits, several times a second
    std::function<void(const std::string& text)> tell;  ///< reports connections, disconnections and their reasons
  };
  /// `who`: what people call the other side, such as `firmware`.
  Conversation(std::unique_ptr<Link> link, std::string who, Callbacks callbacks);

  std::string place() const { return link_->place(); }

  /// The other side is this program from now on, or nullptr: while it runs, what waits below waits in its time and does
  /// not block. It is silent if it has not spoken by the end of the frame, and then goes on in the next one.
  void goes_by_time_of(TimedProgram* program) { program_ = program; }
  /// Returns whether the bridge has started the program, though it may have ended.
  bool has_started_program() const { return program_ != nullptr; }
  bool is_in_virtual_time() const { return program_ != nullptr && program_->runs(); }

  /// Returns the size of the message that `bytes` start with [bytes], or 0 if more bytes are needed to know it or to
  /// have it. Throws std::runtime_error that says why they cannot be the start of a message.
  using Framing = std::function<std::size_t(std::span<const std::uint8_t> bytes)>;

  /// Returns the next message. Nothing if firmware is silent, or has left, beyond what `patience` has for it. In
  /// real time, a call that does not wait and loses the connection returns nothing: the next firmware is heard by the
  /// next call. Throws GaveUp, also where messages never end.
  std::optional<std::vector<std::uint8_t>> receive(const Framing& framing, const Patience& patience);

  /// Waits until firmware is connected. Returns false if none is and `patience` does not wait. Throws GaveUp.
  bool wait_for_connection(const Patience& patience);

  /// Returns how many connections there were, with the one that there is.
  std::size_t connections() const { return connections_; }
  bool is_connected() const { return is_connected_; }

  /// Sends a message to the connected firmware; does nothing without a connection. A program in virtual time that does
  /// not take it now has it before it is heard again. Throws GaveUp.
  void send(std::span<const std::uint8_t> message);

  /// Forgets what has come and was not received: answers to what was sent before.
  void drop_received();

  /// Returns whether the firmware's answer is no longer wanted. Code that waits for it in another way asks several
  /// times a second.
  bool is_given_up() const { return callbacks_.given_up(); }

  /// Tells people something, as in `the firmware TEXT`.
  void tell(const std::string& text) const { callbacks_.tell("the " + who_ + " " + text); }

  /// Ends the connection and tells why, as in `the firmware WHY`.
  void hang_up(const std::string& why);

  /// Ends the connection for good, in silence.
  void leave() { link_->hang_up(); }

  /// A message may not be longer than this [bytes].
  static constexpr std::size_t largest_message = 65536;
  /// Messages to a program in virtual time that does not take them may not be more.
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
  std::vector<std::uint8_t> received_;  // and not taken yet
  TimedProgram* program_ = nullptr;
  std::deque<std::vector<std::uint8_t>> unsent_;  // messages that the program has not read
};

}  // namespace cohort::bridges
