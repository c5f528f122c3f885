// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/bridges/common/descriptor.hpp"
#include "tools/exec/virtual_program.hpp"

namespace cohort::betaflight {

/// A separate network namespace with only a loopback interface. Each program needs one, because its ports are fixed and
/// it binds them at all addresses.
struct Network {
  bridges::Descriptor user, network;  ///< the namespaces
  bridges::Descriptor servo;          ///< UDP, bound to `servo_port`
  bridges::Descriptor cli;            ///< TCP
};
/// Throws std::runtime_error that names the operation that the system does not allow.
Network make_network();

/// A process of Betaflight's SITL program. It ends when this object is destroyed or the process that started it ends.
/// Not thread-safe.
class Program {
 public:
  struct Options {
    std::filesystem::path program;
    std::filesystem::path folder;       ///< its configuration, eeprom.bin, and its output, betaflight.log
    bool has_virtual_time = true;       ///< its clock is simulated time, not the machine's
    std::vector<std::string> commands;  ///< CLI commands that configure it if there is no eeprom.bin
  };

  /// Does not start the program yet. Throws std::runtime_error.
  explicit Program(Options options);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  /// Returns a duplicate of the socket that receives servo packets in the program's network. Throws std::runtime_error.
  bridges::Descriptor servo_socket() const;

  /// Ends the process if there is one, drops the packets that it sent, and starts a new one. Configures the program
  /// first if its folder has no configuration. Throws std::runtime_error that says what went wrong.
  void start();

  /// Returns a message to the user about how the process has ended; nullopt while it runs.
  std::optional<std::string> ended();

  /// Returns the process if it runs in virtual time, otherwise nullptr.
  exec::VirtualProgram* in_virtual_time() { return virtual_ ? &*virtual_ : nullptr; }
  /// Sets the callbacks that are called while the program computes in virtual time: `given_up` returns whether to stop
  /// it, and `tell` receives messages to the user. Objects that they refer to must outlive this.
  void listen(std::function<bool()> given_up, std::function<void(const std::string& text)> tell);

 private:
  void launch();
  void launch_in_virtual_time();
  bridges::Descriptor open_log() const;
  bool enter(const bridges::Descriptor& log) const;
  void end();
  void configure();
  void configure_once();
  void wait_for_end();

  Options options_;
  Network network_;
  pid_t pid_ = -1;
  std::optional<exec::VirtualProgram> virtual_;
  std::function<bool()> given_up_;
  std::function<void(const std::string& text)> tell_;
};

}  // namespace cohort::betaflight
