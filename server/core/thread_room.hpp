#pragma once

#include <exception>
#include <stdexcept>
#include <string>

/// Limits of processes and threads, which containers and users have.
namespace cohort {

/// The error of such a limit. The message names the limits.
class ThreadLimit : public std::runtime_error {
 public:
  /// `what` could not be started, such as `a thread`.
  explicit ThreadLimit(const std::string& what);
};

/// Throws ThreadLimit if this process cannot start so many further threads now. For libraries that end the process
/// then.
void expect_room_for_threads(unsigned count);

/// Returns true if a limit of processes and threads caused the error.
bool is_thread_limit(const std::exception& error);

}  // namespace cohort
