#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/exec/program_options.hpp"

namespace cohort::exec {

/// A program, unmodified, that runs in virtual time: its clocks stand still while it computes, and go on by what this
/// is told. Its processor time, the threads of DDS in it and its input and output are real.
///
/// Its threads end their waits one after the other, by the time at which each ends; those of the same time in the order
/// in which their threads were created. In between, all of them have come to rest. So its threads do not race for
/// shared memory, as long as each waits for time or for another.
///
/// One thread uses it.
class VirtualProgram {
 public:
  using Time = std::chrono::nanoseconds;

  using Options = ProgramOptions;

  /// Starts the program. Throws std::runtime_error that says why it cannot be started, or cannot have virtual time.
  explicit VirtualProgram(Options options);
  /// Ends it, as `end`.
  ~VirtualProgram();
  VirtualProgram(const VirtualProgram&) = delete;
  VirtualProgram& operator=(const VirtualProgram&) = delete;

  /// Returns its monotonic clock.
  Time time() const;

  /// Returns how many nodes of ROS 2 it has.
  std::uint32_t ros_nodes() const;

  /// Runs what is due before `time`, and sets the clock to it. Input that the program has received since it came to
  /// rest is not considered: call `settle` or `run_now` first. Returns false if the program has ended, or is given up.
  bool run_before(Time time);
  /// Runs what is due now, after it has come to rest with what was sent to it. Returns likewise.
  bool run_now();
  /// Waits until every thread of it waits. Returns likewise.
  bool settle();

  /// Returns when the first of its waits ends; nothing if all of them are for something else than time.
  std::optional<Time> next_end() const;
  /// Ends that wait, though its time has not come. Returns as `settle`.
  bool end_next_wait();

  /// Returns its exit code, 128 and the signal's number if a signal ended it; nothing while it runs.
  std::optional<int> exit_code();

  /// Lets its clocks go on by themselves.
  void go_on_in_real_time();
  /// Continues it in real time, asks it to end by SIGTERM, and kills it after `at_most`. Returns its exit code.
  int end(std::chrono::milliseconds at_most = std::chrono::seconds(5));

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns how a program with this exit code has ended, for people.
std::string text_of_end(int exit_code);

}  // namespace cohort::exec
