#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/exec/virtual_program.hpp"

namespace cohort::bridges {

/// A program that a bridge has started, with the time of the robot's frames. It does all its work of a frame at the
/// beginning of the frame, while the simulation stands still. The bridge ends one of its waits after the other, until
/// it has commanded, or until no wait ends before the next frame. One thread.
class TimedProgram {
 public:
  using Time = std::chrono::nanoseconds;

  struct Options {
    std::string command;                                 ///< for the shell
    std::vector<std::string> environment;                ///< NAME=VALUE
    Time start{0};                                       ///< its clock at first: time of the first frame
    std::function<bool()> given_up;                      ///< asked while it computes, several times a second
    std::function<void(const std::string& text)> tell;   ///< reports actions that virtual time does not support
    std::function<void(const std::string& text)> ended;  ///< how, for people
  };
  /// Starts it. Throws std::runtime_error.
  explicit TimedProgram(Options options);

  /// Returns whether it has not ended, as far as it is known.
  bool runs() const { return runs_; }
  std::uint32_t ros_nodes() const { return program_.ros_nodes(); }

  /// Runs what is due before a frame of `time`, whose successor is to come at `end`. In another run, as after a reset,
  /// its clock goes on from where it is. Throws GaveUp, as those below.
  void begin_frame(Time time, Time end, bool is_other_run);
  /// Waits until every thread of it waits. Returns `runs`.
  bool settle();
  /// Waits until every thread of it waits. Returns whether the next of its waits is due before the end of the frame.
  bool is_due();
  /// Ends the next of its waits, if that is due before the end of the frame, and waits until it rests. Returns false if
  /// it has ended, or if no wait is due; then it also sets the program's clock to the end of the frame.
  bool go_on();

  /// Ends it: its clocks go on by themselves, and after `at_most` it is asked to end.
  void end(std::chrono::milliseconds at_most);

 private:
  bool check(bool runs);

  std::function<void(const std::string& text)> ended_;
  exec::VirtualProgram program_;
  bool runs_ = true;
  Time ahead_{0};  // its clock, of the run's time
  Time end_{0};    // end of the frame, by the program's clock
};

}  // namespace cohort::bridges
