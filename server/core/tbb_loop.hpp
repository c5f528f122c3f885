#pragma once

#include <cstddef>
#include <memory>

namespace cohort {

/// oneTBB's parallel loop. In a file of its own because that is built without ThreadSanitizer, which would take the way
/// oneTBB's templates and its library hand tasks over for races. Who calls it has to tell ThreadSanitizer what is
/// ordered: see worker_pool.cpp.
class TbbLoop {
 public:
  using Call = void (*)(void* argument, std::size_t index, unsigned worker);

  /// `threads` >= 2, the caller's included; may exceed the number of cores.
  explicit TbbLoop(unsigned threads);
  ~TbbLoop();

  /// Calls `call` for each index below `count`, no two at once with the same `worker` < threads. An exception is passed
  /// on.
  void run(std::size_t count, Call call, void* argument);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace cohort
