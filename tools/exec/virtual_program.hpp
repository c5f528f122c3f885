// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/exec/program_options.hpp"

namespace cohort::exec {

/// An unmodified program that runs in virtual time: its clocks stand still while it computes, and advance only when
/// this class is told to advance them. Its processor time, its DDS threads, and its input and output are real.
///
/// Its threads end their waits one after the other, in the order of their deadlines; waits with the same deadline in
/// the order in which the threads were created. Before each of these, all threads have come to rest. Therefore its
/// threads do not race for shared memory, as long as each waits for a time or for another thread.
///
/// Not thread-safe.
class VirtualProgram {
 public:
  using Time = std::chrono::nanoseconds;

  using Options = ProgramOptions;

  /// Starts the program. Throws std::runtime_error that says why it cannot be started or cannot run in virtual time.
  explicit VirtualProgram(Options options);
  /// Ends the program, like `end`.
  ~VirtualProgram();
  VirtualProgram(const VirtualProgram&) = delete;
  VirtualProgram& operator=(const VirtualProgram&) = delete;

  /// Returns the time of the program's monotonic clock.
  Time time() const;

  /// Returns the number of the program's ROS 2 nodes.
  std::uint32_t ros_nodes() const;

  /// Runs everything that is due before `time`, and sets the clock to `time`. Ignores input that the program has
  /// received since it came to rest: call `settle` or `run_now` first. Returns false if the program has ended or was
  /// given up.
  bool run_before(Time time);
  /// Waits until the program has processed its input and come to rest, then runs everything that is due now. Returns
  /// false like `run_before`.
  bool run_now();
  /// Waits until every thread of the program waits. Returns false like `run_before`.
  bool settle();

  /// Returns the earliest deadline of the program's waits; nullopt if none of them has a deadline.
  std::optional<Time> next_end() const;
  /// Ends the wait with the earliest deadline, even before that deadline. Returns false like `settle`.
  bool end_next_wait();

  /// Returns the program's exit code, or 128 plus the signal's number if a signal ended it; nullopt while it runs.
  std::optional<int> exit_code();

  /// Lets the program's clocks run in real time from now on.
  void go_on_in_real_time();
  /// Continues the program in real time, sends SIGTERM, and kills it after `at_most`. Returns its exit code.
  int end(std::chrono::milliseconds at_most = std::chrono::seconds(5));

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns a message to the user about how a program with this exit code has ended.
std::string text_of_end(int exit_code);

}  // namespace cohort::exec
