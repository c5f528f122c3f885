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

/// A network of its own, with nothing but a loopback: the program's ports are fixed, and it takes them at all
/// addresses.
struct Network {
  bridges::Descriptor user, network;  ///< the namespaces
  bridges::Descriptor servo;          ///< UDP, bound to `servo_port`
  bridges::Descriptor cli;            ///< TCP
};
/// Throws std::runtime_error that says what the system does not allow.
Network make_network();

/// A process of Betaflight's SITL program. Ends with this, and with the process that has started it. One thread.
class Program {
 public:
  struct Options {
    std::filesystem::path program;
    std::filesystem::path folder;       ///< has its configuration, eeprom.bin, and what it writes: betaflight.log
    bool has_virtual_time = true;       ///< the simulation's, else its clock is the machine's
    std::vector<std::string> commands;  ///< CLI commands that configure it if there is no eeprom.bin
  };

  /// Starts nothing yet. Throws std::runtime_error.
  explicit Program(Options options);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  /// Returns another descriptor of the socket that servo packets come to, in the program's network. Throws
  /// std::runtime_error.
  bridges::Descriptor servo_socket() const;

  /// Ends the process if there is one, and restarts it, after what earlier ones sent is forgotten;
  /// configures it before if its folder has no configuration.
  /// Throws std::runtime_error that says what went wrong.
  void start();

  /// Returns how the process has ended, for people; nothing while it runs.
  std::optional<std::string> ended();

  /// Returns the process in virtual time; nullptr if its clock is the machine's, or if it does not run.
  exec::VirtualProgram* in_virtual_time() { return virtual_ ? &*virtual_ : nullptr; }
  /// Sets the callbacks that are called while it computes in virtual time: `given_up`, and `tell` with messages. They
  /// outlive this.
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
