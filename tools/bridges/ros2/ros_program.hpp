#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "tools/bridges/common/timed_program.hpp"
#include "tools/exec/thread_watch.hpp"

namespace cohort::ros2 {

/// The program that a bridge has started, such as nodes or a launch file, with the simulation's time as its own. Its
/// work for a time is done when all of its threads wait. The threads of DDS here, which receive its messages, wait then
/// too: datagrams on one machine are in the receiver's socket when the sender's call returns. One thread.
class RosProgram {
 public:
  struct Options {
    std::string command;                                ///< for the shell
    std::uint32_t domain = 0;                           ///< ROS domain
    std::chrono::nanoseconds start{0};                  ///< its clocks at first
    std::function<bool()> given_up;                     ///< asked while it computes, several times a second
    std::function<void(const std::string& text)> tell;  ///< to people
  };
  /// Starts it. Throws std::runtime_error.
  explicit RosProgram(const Options& options);

  /// Returns whether it has not ended, as far as it is known.
  bool runs() const { return program_.runs(); }
  /// Returns how many nodes it has.
  std::uint32_t nodes() const { return program_.ros_nodes(); }
  /// Runs what is due before a frame of `time`, whose successor comes at `end`. Throws bridges::GaveUp, as those below.
  void begin_frame(std::chrono::nanoseconds time, std::chrono::nanoseconds end, bool is_other_run);
  /// Waits until it has done all that it does now, and what it has sent is received.
  void settle();
  /// Returns whether one of its waits is due in the frame.
  bool is_due() { return program_.is_due(); }
  /// Ends the next of its waits that is due in the frame. Returns false if none is; its clocks are then at the end.
  bool go_on();
  /// Ends it; after `at_most` by force.
  void end(std::chrono::milliseconds at_most) { program_.end(at_most); }

 private:
  void wait_for_own_threads();

  std::function<bool()> given_up_;
  exec::ThreadWatch own_threads_;
  bridges::TimedProgram program_;
};

}  // namespace cohort::ros2
