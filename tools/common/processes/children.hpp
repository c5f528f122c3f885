// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace cohort::tool {

/// Child processes of this process. A child that dies is restarted, up to a limit. The destructor ends all children and
/// the rest of their process groups; they also die if this process is killed. Their standard input is empty,
/// and what they write to standard output goes to standard error.
class Children {
 public:
  static constexpr int most_restarts = 3;  ///< limit of restarts of each child

  struct Command {
    std::vector<std::string> arguments;  ///< the program's path first
    std::string name;                    ///< name in messages
    bool restarts = true;                ///< restart it if it dies
    bool is_controller = true;           ///< it drives robots; only used in messages
  };

  /// Callbacks, called on a thread of this class, one at a time. `gave_up`, `restarted` and `killed` get a message for
  /// users.
  struct Listener {
    std::function<void(const Command& command, pid_t pid)> started{};
    /// Called before other callbacks for its end. `exit_code` is -1 if a signal ended it.
    std::function<void(pid_t pid, int exit_code)> ended{};
    std::function<void(const Command& command, const std::string& text)> restarted{};
    std::function<void(const std::string& text)> gave_up{};  ///< a child died and is not restarted
    std::function<void(const Command& command, const std::string& text)> killed{};  ///< a child did not end on request
    /// If set, receives each line that a child writes to standard output or standard error. Otherwise the lines go to
    /// the standard error of this process.
    std::function<void(const Command& command, const std::string& line)> wrote{};
    /// Returns whether a child may end with this code before `stop_restarting` is called. Any other end counts as a
    /// death.
    std::function<bool(int exit_code)> may_end_with{};
  };

  /// Starts the children. Throws std::system_error.
  Children(std::vector<Command> commands, Listener listener);
  /// Ends the remaining children by SIGTERM, and after two seconds by SIGKILL.
  ~Children();

  /// Allows children to end from now on.
  void stop_restarting() { restarting_ = false; }
  /// Ends the children, but gives them two seconds to end by themselves first.
  void let_finish();

 private:
  struct Child {
    Command command;
    pid_t pid = -1;  // -1: not running
    int pidfd = -1;  // also -1 if the kernel does not support it
    int output = -1;
    std::string line{};  // incomplete line of output
    int restarts = 0;
  };
  void start(Child& child);
  void watch();
  void join();
  bool reap_until(std::chrono::steady_clock::time_point deadline);
  void reap(Child& child);
  void handle_end(Child& child, int status);
  void read_output(Child& child);
  void signal_all(int number);

  std::vector<Child> children_;
  Listener listener_;
  int wake_pipe_[2] = {-1, -1};
  std::atomic<bool> restarting_ = true;
  std::atomic<bool> finishing_ = false;
  std::atomic<bool> patient_ = false;  // children know that the run is over
  std::thread watcher_;
};

}  // namespace cohort::tool
