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

/// `stop` was set while this process waited for another one.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Returns the path of a program in $PATH, or nothing.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// A child process that a socket connects with this one. It runs in its own process group, so Ctrl-C does not reach it,
/// and it dies if this process is killed. All members throw Interrupted once `stop` is set. One thread.
class ConnectedProgram {
 public:
  /// Starts a program. `command`: its path and its arguments. `descriptors`: the descriptors of the program that are
  /// the socket, such as {0} for its standard input. `variables`: changes of its environment, such as HOME=/tmp. Throws
  /// std::system_error. `stop` must outlive this.
  ConnectedProgram(const std::vector<std::string>& command, const std::vector<int>& descriptors,
                   const std::atomic<bool>& stop, const std::vector<std::string>& variables = {});
  ConnectedProgram(const ConnectedProgram&) = delete;
  ConnectedProgram& operator=(const ConnectedProgram&) = delete;
  /// Kills the process group if the program has not ended.
  ~ConnectedProgram();

  /// Sends all bytes. Throws std::runtime_error with the last lines that the program has printed if it does not read.
  void send(std::string_view bytes);
  /// Returns the received bytes up to a character, which is removed. Throws std::runtime_error if the program closes
  /// the socket, sends more than `most` bytes, or sends no such character within `patience`.
  std::string receive(char end, std::size_t most, std::chrono::seconds patience);
  /// Ends what it receives, and waits until it has ended. Returns its exit code.
  int finish();
  /// Closes the socket, and kills the process group if the program does not end within `patience`.
  void close(std::chrono::milliseconds patience);

  /// Returns the end of what the program has printed.
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
