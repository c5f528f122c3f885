// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "tools/bridges/common/timed_program.hpp"
#include "tools/exec/thread_watch.hpp"

namespace cohort::ros2 {

/// A program that the bridge has started in virtual time, such as nodes or a launch file. Its work for a time is done
/// when all its threads wait, and the DDS threads of this process, which receive its messages, wait too. This is
/// sufficient because a datagram on one machine is in the receiver's socket when the sender's call returns. Not
/// thread-safe.
class RosProgram {
 public:
  struct Options {
    std::string command;                                ///< shell command
    std::uint32_t domain = 0;                           ///< ROS domain
    std::chrono::nanoseconds start{0};                  ///< initial time of its clocks
    std::function<bool()> given_up;                     ///< asked several times a second while it computes
    std::function<void(const std::string& text)> tell;  ///< reports to the user
  };
  /// Starts the program. Throws std::runtime_error.
  explicit RosProgram(const Options& options);

  /// Returns whether the program was still running when last checked.
  bool runs() const { return program_.runs(); }
  /// Returns the number of the program's ROS nodes.
  std::uint32_t nodes() const { return program_.ros_nodes(); }
  /// Runs everything that is due before a frame that lasts from `time` to `end`. Throws bridges::GaveUp, like the
  /// functions below.
  void begin_frame(std::chrono::nanoseconds time, std::chrono::nanoseconds end, bool is_other_run);
  /// Waits until the program has done its work for the present time, and its messages have been received.
  void settle();
  /// Returns whether one of the program's waits ends within the frame.
  bool is_due() { return program_.is_due(); }
  /// Ends the next wait that is due within the frame. If none is due, sets the clocks to the end of the frame and
  /// returns false.
  bool go_on();
  /// Ends the program, by force after `at_most`.
  void end(std::chrono::milliseconds at_most) { program_.end(at_most); }

 private:
  void wait_for_own_threads();

  std::function<bool()> given_up_;
  exec::ThreadWatch own_threads_;
  bridges::TimedProgram program_;
};

}  // namespace cohort::ros2
