#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/bridges/common/firmware.hpp"

namespace cohort::bridges {

/// One robot that firmware drives: a client of its own on a thread of its own, so that the other robots go on while
/// this one waits for its firmware.
class RobotBridge {
 public:
  struct Options {
    ClientOptions client;  ///< `robots` names the robot
    std::string link;      ///< as `open_link` takes it
    std::string who = "firmware";
  };

  /// Opens the link and says where firmware reaches it. The bridge ends when `stop` is set, and sets it if it fails.
  /// Throws std::runtime_error.
  RobotBridge(Options options, std::unique_ptr<Firmware> firmware, Patience patience, std::atomic<bool>& stop);
  RobotBridge(const RobotBridge&) = delete;
  RobotBridge& operator=(const RobotBridge&) = delete;
  ~RobotBridge();

  void start();
  /// Waits for its end.
  ClientEnd wait();

 private:
  void run();
  ClientEnd drive(Client& client);
  void answer(const Frame& frame);
  void tell(const std::string& text) const;

  Options options_;
  std::unique_ptr<Firmware> firmware_;
  Patience patience_;
  std::atomic<bool>& stop_;
  const Client* client_ = nullptr;  // while it runs
  Conversation conversation_;
  ClientEnd end_ = ClientEnd::failed;
  std::thread thread_;
};

/// Runs bridges until all have ended, and returns the exit code of their program: that of the first that ended
/// otherwise than by the run's end or by the end of the others.
int run_bridges(const std::vector<std::unique_ptr<RobotBridge>>& bridges);

}  // namespace cohort::bridges
