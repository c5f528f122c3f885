// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/exec/virtual_program.hpp"

namespace cohort::bridges {

/// A program that a bridge has started in virtual time, which follows the robot's frames. The program does all its work
/// of a frame at the beginning of the frame, while the simulation stands still. The bridge ends the program's waits one
/// after the other, until the program has sent a command or no wait ends before the next frame. Not thread-safe.
class TimedProgram {
 public:
  using Time = std::chrono::nanoseconds;

  struct Options {
    std::string command;                                 ///< shell command
    std::vector<std::string> environment;                ///< NAME=VALUE
    Time start{0};                                       ///< initial time of its clock: that of the first frame
    std::function<bool()> given_up;                      ///< called several times a second while it computes
    std::function<void(const std::string& text)> tell;   ///< reports actions that virtual time does not support
    std::function<void(const std::string& text)> ended;  ///< receives how it ended
  };
  /// Starts the program. Throws std::runtime_error.
  explicit TimedProgram(Options options);

  /// Returns whether the program was still running when last checked.
  bool runs() const { return runs_; }
  std::uint32_t ros_nodes() const { return program_.ros_nodes(); }

  /// Runs everything that is due before a frame that lasts from `time` to `end`. In another run, such as after a reset,
  /// the program's clock continues from its present time. Throws GaveUp, like the functions below.
  void begin_frame(Time time, Time end, bool is_other_run);
  /// Waits until every thread of the program waits. Returns `runs`.
  bool settle();
  /// Waits until every thread of the program waits. Returns whether the next of these waits ends before the end of the
  /// frame.
  bool is_due();
  /// Ends the program's next wait, if that is due before the end of the frame, and waits until all threads wait again.
  /// Returns false if the program has ended or no wait is due. In the latter case, also sets the program's clock to the
  /// end of the frame.
  bool go_on();

  /// Ends the program: lets its clocks run in real time, and asks it to end after `at_most`.
  void end(std::chrono::milliseconds at_most);

 private:
  bool check(bool runs);

  std::function<void(const std::string& text)> ended_;
  exec::VirtualProgram program_;
  bool runs_ = true;
  Time ahead_{0};  // offset of its clock relative to the run's time
  Time end_{0};    // end of the frame, by the program's clock
};

}  // namespace cohort::bridges
