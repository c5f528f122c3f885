#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace cohort::tool {

/// Processes that this one started and answers for. One that dies is started again, a few times; all are gone when this
/// is, with whatever is left of their process groups, and they die if this process is killed. Their standard input is
/// empty.
class Children {
 public:
  static constexpr int most_restarts = 3;  ///< of each child

  struct Command {
    std::vector<std::string> arguments;  ///< the program's path first
    std::string name;                    ///< for messages: what it is for
    bool restarts = true;                ///< if it dies
  };

  /// Called on a thread of this, one at a time. `gave_up`, `restarted` and `killed` have a text for people.
  struct Listener {
    std::function<void(const Command& command, pid_t pid)> started{};
    std::function<void(pid_t pid)> ended{};  ///< before anything else is said of it
    std::function<void(const Command& command, const std::string& text)> restarted{};
    std::function<void(const std::string& text)> gave_up{};  ///< a child died that is not started again
    std::function<void(const Command& command, const std::string& text)>
        killed{};  ///< one that did not end when told to
    /// If set, receives each line that a child writes to standard error, which otherwise is ours.
    std::function<void(const Command& command, const std::string& line)> wrote{};
    /// Whether a child may end with this code before `stop_restarting` was called. Otherwise that is a death.
    std::function<bool(int exit_code)> may_end_with{};
  };

  /// Throws std::system_error.
  Children(std::vector<Command> commands, Listener listener);
  /// Ends those that are left: by SIGTERM, and after two seconds by SIGKILL.
  ~Children();

  /// From now on a child may end as it likes.
  void stop_restarting() { restarting_ = false; }
  /// Gives them two seconds to end by themselves, before they are ended.
  void let_finish();

 private:
  struct Child {
    Command command;
    pid_t pid = -1;  // -1: not running
    int pidfd = -1;  // -1 also if the kernel has none to give
    int output = -1;
    std::string line{};  // of output, as far as it is there
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
  std::atomic<bool> patient_ = false;  // they were told that it is over
  std::thread watcher_;
};

}  // namespace cohort::tool
