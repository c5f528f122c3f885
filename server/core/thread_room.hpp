// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

/// Limits on the number of processes and threads of a container or a user.
namespace cohort {

/// The error thrown if such a limit is reached. The message names the limits.
class ThreadLimit : public std::runtime_error {
 public:
  /// `what` could not be started, such as `a thread`.
  explicit ThreadLimit(const std::string& what);
};

/// Throws ThreadLimit if this process cannot start `count` more threads now. Call this before a library that would
/// otherwise end the process.
void expect_room_for_threads(unsigned count);

/// Returns true if a limit on processes or threads caused the error.
bool is_thread_limit(const std::exception& error);

}  // namespace cohort
