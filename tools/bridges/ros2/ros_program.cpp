// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/ros_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <thread>

#include "tools/bridges/common/gave_up.hpp"

namespace cohort::ros2 {

RosProgram::RosProgram(const Options& options)
    : given_up_(options.given_up),
      program_({.command = options.command,
                // LTTng, which ROS is traced by, waits seconds for its daemon before a program begins.
                .environment = {"ROS_DOMAIN_ID=" + std::to_string(options.domain), "LTTNG_UST_REGISTER_TIMEOUT=0"},
                .start = options.start,
                .given_up = options.given_up,
                .tell = options.tell,
                .ended = [tell = options.tell, command = options.command](const std::string& how) {
                  tell("'" + command + "' " + how);
                }}) {}

void RosProgram::begin_frame(std::chrono::nanoseconds time, std::chrono::nanoseconds end, bool is_other_run) {
  program_.begin_frame(time, end, is_other_run);
}

void RosProgram::settle() {
  // Messages that are received here may wake threads of DDS there, by an acknowledgement, and the other way round.
  for (int i = 0; i < 2 && program_.settle(); ++i) wait_for_own_threads();
}

bool RosProgram::go_on() {
  const bool is_due = program_.go_on();
  settle();
  return is_due;
}

void RosProgram::wait_for_own_threads() {
  constexpr std::chrono::microseconds first_nap{20};
  constexpr std::chrono::microseconds longest_nap{1000};
  own_threads_.look_at({::getpid()}, ::gettid());
  for (auto nap = first_nap; !own_threads_.all_wait(); nap = std::min(2 * nap, longest_nap)) {
    if (given_up_()) throw bridges::GaveUp{};
    std::this_thread::sleep_for(nap);
    if (own_threads_.has_changed()) own_threads_.look_at({::getpid()}, ::gettid());
  }
}

}  // namespace cohort::ros2
