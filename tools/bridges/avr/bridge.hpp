// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cohort/client.hpp>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/bridges/avr/avr_robot.hpp"
#include "tools/bridges/avr/medium.hpp"

namespace cohort::avr {

/// One client for all robots: each frame contains all robots that are due, and their microcontrollers run on several
/// threads. A robot's outputs depend only on its own inputs and on signals that others sent in earlier windows.
/// Therefore the results do not depend on the number of threads.
class Bridge {
 public:
  struct Options {
    ClientOptions client;
    std::vector<Robot::Options> robots;  ///< one for all, or one for each in the order of their ids
    unsigned threads = 1;
    std::function<std::unique_ptr<Board>()> make_board;
    /// Sets the options that differ between robots, such as the serial number; may be empty.
    std::function<void(Robot::Options&, const Start&)> prepare{};
    Medium* medium = nullptr;  ///< carries signals between the boards; nullptr: none
  };
  explicit Bridge(Options options) : options_(std::move(options)) {}

  /// Drives the robots until the run ends or `stop` is set.
  ClientEnd run(const std::atomic<bool>& stop);

 private:
  void start(const LeaseStart& lease);
  void step(const Frame& frame);
  void step_in_windows(const Frame& frame, std::vector<std::exception_ptr>& failures);
  const Robot::Options& options_of(std::size_t place, std::size_t robots) const;
  std::shared_ptr<bridges::Link> pty_of(const std::string& name);

  Options options_;
  std::map<std::uint32_t, std::unique_ptr<Robot>> robots_;      // by id
  std::map<std::string, std::shared_ptr<bridges::Link>> ptys_;  // by name of the robot
};

}  // namespace cohort::avr
