// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace cohort {

/// A parallel loop of oneTBB. Its source file is built without ThreadSanitizer, which would report races in oneTBB's
/// handover of tasks between its templates and its library. The caller must describe the ordering to ThreadSanitizer:
/// see worker_pool.cpp.
class TbbLoop {
 public:
  using Call = void (*)(void* argument, std::size_t index, unsigned worker);

  /// `threads` >= 2, including the caller's; may exceed the number of cores. Throws ThreadLimit.
  explicit TbbLoop(unsigned threads);
  ~TbbLoop();

  /// Calls `call` for each index below `count`. No two concurrent calls have the same `worker` < threads. Exceptions
  /// are passed on.
  void run(std::size_t count, Call call, void* argument);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace cohort
