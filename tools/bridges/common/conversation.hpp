#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/bridges/common/link.hpp"

namespace cohort::bridges {

/// Thrown while a conversation waits, when nobody wants the firmware's answer any more.
struct GaveUp {};

/// What happens to a robot whose firmware is not connected, or does not answer in time.
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

/// Messages to and from one robot's firmware. Waits where a Link does not. What firmware sends wrong ends its
/// connection, with a line for people. One thread.
class Conversation {
 public:
  struct Callbacks {
    std::function<bool()> given_up;                     ///< asked while it waits, several times a second
    std::function<void(const std::string& text)> tell;  ///< who connects and leaves, and why
  };
  /// `who`: what people call the other side, such as `firmware`.
  Conversation(std::unique_ptr<Link> link, std::string who, Callbacks callbacks);

  std::string place() const { return link_->place(); }

  /// Returns the size of the message that `bytes` start with [bytes], or 0 if more bytes are needed to know it or to
  /// have it. Throws std::runtime_error that says why they cannot be the start of a message.
  using Framing = std::function<std::size_t(std::span<const std::uint8_t> bytes)>;

  /// Returns the next message. Nothing if firmware is silent, or has left, beyond what `patience` has for it. Throws
  /// GaveUp.
  std::optional<std::vector<std::uint8_t>> receive(const Framing& framing, const Patience& patience);

  /// Sends a message to whoever is connected; does nothing if nobody is. Throws GaveUp.
  void send(std::span<const std::uint8_t> message);

  /// Ends the connection and tells why, as in `the firmware WHY`.
  void hang_up(const std::string& why);

  /// A message may not be longer than this [bytes].
  static constexpr std::size_t largest_message = 65536;

 private:
  bool connect();
  bool read_more();
  std::optional<std::vector<std::uint8_t>> take(const Framing& framing);
  void wait_for(short event, std::chrono::steady_clock::time_point until) const;

  std::unique_ptr<Link> link_;
  std::string who_;
  Callbacks callbacks_;
  bool is_connected_;
  std::size_t expected_size_ = 0;       // of the message that is coming; 0 while it is not known
  std::vector<std::uint8_t> received_;  // and not taken yet
};

}  // namespace cohort::bridges
