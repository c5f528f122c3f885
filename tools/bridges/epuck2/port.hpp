#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "tools/bridges/epuck2/packets.hpp"

namespace cohort::epuck2 {

/// A file descriptor that is closed with this.
class Socket {
 public:
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// The TCP port at which programs reach one robot, one program at a time, as at the robot: others wait. What a program
/// does wrong ends its connection, with a line for people. One thread.
class Port {
 public:
  struct Callbacks {
    std::function<bool()> given_up;                       ///< asked while it waits, several times a second
    std::function<void(const std::string& text)> tell{};  ///< who came, who left, and why
  };

  /// Listens at `address`, an IPv4 address of this machine; at any free port if `port` is 0. Throws std::runtime_error.
  Port(const std::string& address, std::uint16_t port, Callbacks callbacks);

  std::uint16_t number() const { return number_; }

  enum class Patience {
    until_a_command_comes,   ///< whoever sends it
    while_one_is_connected,  ///< or is about to be; nothing if nobody is, or who was has left
  };
  /// The next command. Throws LeaveRun when `given_up` says so.
  std::optional<Command> next_command(Patience patience);

  /// Sends to the program that the last command came from; nothing if it has gone. Throws as `next_command`.
  void send(std::span<const std::uint8_t> packet);

 private:
  bool accept(bool wait);
  std::optional<Command> receive();
  void hang_up(const std::string& why);
  void wait_for(int descriptor, short event) const;

  Callbacks callbacks_;
  Socket listener_;
  std::uint16_t number_ = 0;
  std::optional<Socket> program_;
};

}  // namespace cohort::epuck2
