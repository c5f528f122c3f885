// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/bridges/common/firmware.hpp"

namespace cohort::bridges {

/// One robot's firmware, and the link to it.
struct Driver {
  std::unique_ptr<Firmware> firmware;
  std::unique_ptr<Link> link;
};

/// One robot that firmware drives. It has its own client and thread, so that the other robots continue while this one
/// waits for its firmware.
class RobotBridge {
 public:
  struct Options {
    ClientOptions client;  ///< `robots` names the robot
    std::string who = "firmware";
    std::string command{};  ///< shell command of a program that is started for the robot; empty: none
  };

  /// Reports to the user where the firmware connects. The bridge ends when `stop` is set, and sets it if it fails.
  RobotBridge(Options options, Driver driver, Patience patience, std::atomic<bool>& stop);
  RobotBridge(const RobotBridge&) = delete;
  RobotBridge& operator=(const RobotBridge&) = delete;
  ~RobotBridge();

  void start();
  /// Waits for the end of the bridge.
  ClientEnd wait();

 private:
  void run();
  ClientEnd drive(Client& client);
  void begin_frame(const Frame& frame, const Start& robot);
  void answer(Client& client, const Frame& frame);
  void start_program(std::chrono::nanoseconds time);
  void end_program();
  void tell(const std::string& text) const;

  Options options_;
  std::unique_ptr<Firmware> firmware_;
  Patience patience_;
  std::atomic<bool>& stop_;
  const Client* client_ = nullptr;  // while it runs
  Conversation conversation_;
  std::unique_ptr<TimedProgram> program_;
  bool is_other_run_ = false;  // the next frame is of another run than the last one
  ClientEnd end_ = ClientEnd::failed;
  std::thread thread_;
};

/// Runs bridges until all have ended. Returns the program's exit code: that of the first bridge that ended for another
/// reason than the end of the run or of the other bridges.
int run_bridges(const std::vector<std::unique_ptr<RobotBridge>>& bridges);

}  // namespace cohort::bridges
