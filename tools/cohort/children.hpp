#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace cohort::tool {

/// Processes that this one started and answers for: a child that ends with an error is started again, a few times; all
/// are gone when this is, and also if this process is killed.
class Children {
 public:
  static constexpr int most_restarts = 3;  ///< of each child

  struct Listener {
    std::function<void(const std::string& text)> restarted;
    std::function<void(const std::string& text)> gave_up;  ///< a child failed once too often; called from a thread
  };

  /// `commands`: arguments of each child, the program's path first. Throws std::system_error.
  Children(std::vector<std::vector<std::string>> commands, Listener listener);
  /// Ends them: first by SIGTERM, after two seconds by SIGKILL.
  ~Children();

  /// From now on a child may end as it likes.
  void stop_restarting() { restarting_ = false; }
  /// Gives them a moment to end by themselves.
  void let_finish();

 private:
  struct Child {
    std::vector<std::string> command;
    pid_t pid = -1;  // -1: not running
    int pidfd = -1;
    int restarts = 0;
  };
  void start(Child& child);
  void watch();
  void handle_end(Child& child, int status);
  bool reap_until(std::chrono::steady_clock::time_point deadline);

  std::vector<Child> children_;
  Listener listener_;
  int wake_pipe_[2];
  std::atomic<bool> restarting_ = true;
  std::atomic<bool> finishing_ = false;
  std::thread watcher_;
};

}  // namespace cohort::tool
