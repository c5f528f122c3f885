// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::tool {

/// Thrown if `stop` is set while this process waits for another one.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Returns the path of a program in $PATH, or nothing.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// A child process that is connected to this one by a socket. It runs in its own process group, so Ctrl-C does not
/// reach it, and it dies if this process is killed. All members throw Interrupted once `stop` is set. Not thread-safe.
class ConnectedProgram {
 public:
  /// Starts a program. `command` has its path and arguments. `descriptors` are the program's descriptors for the
  /// socket, such as {0} for its standard input. `variables` change its environment, such as HOME=/tmp. `stop` must
  /// outlive this. Throws std::system_error.
  ConnectedProgram(const std::vector<std::string>& command, const std::vector<int>& descriptors,
                   const std::atomic<bool>& stop, const std::vector<std::string>& variables = {});
  ConnectedProgram(const ConnectedProgram&) = delete;
  ConnectedProgram& operator=(const ConnectedProgram&) = delete;
  /// Kills the process group if the program has not ended.
  ~ConnectedProgram();

  /// Sends all bytes. Throws std::runtime_error with the last lines that the program has printed if the program does
  /// not read them.
  void send(std::string_view bytes);
  /// Returns the received bytes up to a character, which is removed. Throws std::runtime_error if the program closes
  /// the socket, sends more than `most` bytes, or sends no such character within `patience`.
  std::string receive(char end, std::size_t most, std::chrono::seconds patience);
  /// Closes the sending side of the socket, and waits until the program has ended. Returns its exit code.
  int finish();
  /// Closes the socket, and kills the process group if the program does not end within `patience`.
  void close(std::chrono::milliseconds patience);

  /// Returns the last part of the program's output.
  const std::string& printed() const { return printed_; }

 private:
  enum class Event { none, readable, writable };
  Event wait(bool for_writing);
  void read_printed();
  bool has_ended() const;
  void reap();
  [[noreturn]] void fail(const std::string& what) const;

  const std::atomic<bool>& stop_;
  std::string name_;
  pid_t pid_ = -1;
  int socket_ = -1;
  int output_ = -1;  // pipe of standard output and standard error
  std::string received_;
  std::string printed_;
  int exit_code_ = 0;
};

}  // namespace cohort::tool
