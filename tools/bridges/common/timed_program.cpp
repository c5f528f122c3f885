// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/timed_program.hpp"

#include <unistd.h>

#include <optional>
#include <thread>
#include <utility>

#include "tools/bridges/common/gave_up.hpp"

namespace cohort::bridges {
namespace {

constexpr std::chrono::milliseconds end_is_looked_for_every{5};

exec::VirtualProgram::Options in_virtual_time(TimedProgram::Options options) {
  exec::VirtualProgram::Options made;
  made.command = {"sh", "-c", options.command};
  made.name = std::move(options.command);
  made.environment = std::move(options.environment);
  made.start = options.start;
  // Ctrl-C interrupts only the bridge, which ends the program.
  made.prepare = [] { return ::setpgid(0, 0) == 0; };
  made.given_up = std::move(options.given_up);
  made.tell = std::move(options.tell);
  return made;
}

}  // namespace

TimedProgram::TimedProgram(Options options)
    : ended_(std::move(options.ended)), program_(in_virtual_time(std::move(options))) {}

bool TimedProgram::check(bool runs) {
  if (runs) return true;
  const std::optional<int> code = program_.exit_code();
  if (!code) throw GaveUp{};
  if (!std::exchange(runs_, false)) return false;
  program_.end();  // its remaining child processes continue in real time
  ended_(exec::text_of_end(*code));
  return false;
}

void TimedProgram::begin_frame(Time time, Time end, bool is_other_run) {
  if (!settle()) return;
  if (is_other_run) ahead_ = program_.time() - time;
  end_ = end + ahead_;
  check(program_.run_before(time + ahead_));
}

bool TimedProgram::settle() { return runs_ && check(program_.settle()); }

bool TimedProgram::is_due() {
  if (!settle()) return false;
  const std::optional<Time> next = program_.next_end();
  return next && *next < end_;
}

bool TimedProgram::go_on() {
  const bool ends_one = is_due();
  if (!runs_ || !check(program_.run_before(ends_one ? *program_.next_end() : end_)) || !ends_one) return false;
  return check(program_.end_next_wait());
}

void TimedProgram::end(std::chrono::milliseconds at_most) {
  if (!std::exchange(runs_, false)) return;
  program_.go_on_in_real_time();
  const auto until = std::chrono::steady_clock::now() + at_most;
  while (!program_.exit_code() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(end_is_looked_for_every);
  // A program that failed shortly before the end of the run may need real time to exit.
  if (const std::optional<int> code = program_.exit_code(); code && *code != 0) ended_(exec::text_of_end(*code));
  program_.end();
}

}  // namespace cohort::bridges
