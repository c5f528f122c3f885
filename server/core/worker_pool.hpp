// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace cohort {

/// The threads of one simulation, based on oneTBB. A loop runs in chunks whose bounds depend only on `count` and
/// `grain`. Results are deterministic if a chunk writes only data of its indices, and its worker's scratch memory.
/// Scratch memory must not carry over from one chunk to the next.
class WorkerPool {
 public:
  /// `threads` from 1 to 1024, including the caller's; may exceed the number of cores. Throws ThreadLimit.
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();

  unsigned threads() const { return threads_; }

  /// A grain for indices that take microseconds each.
  static constexpr std::size_t fine = 8;

  /// Calls `body(begin, end, worker)` for chunks of at most `grain` indices that cover [0, count), and returns when all
  /// are done. `worker` < threads(), and no two concurrent chunks have the same one. Exceptions are passed on. Only one
  /// loop may run at a time: do not call this inside a chunk, or on two threads at once.
  template <class Body>
  void for_each_chunk(std::size_t count, std::size_t grain, Body&& body) {
    using Plain = std::remove_reference_t<Body>;
    run(
        count, grain,
        [](void* b, std::size_t begin, std::size_t end, unsigned worker) {
          (*static_cast<Plain*>(b))(begin, end, worker);
        },
        const_cast<void*>(static_cast<const void*>(&body)));
  }

 private:
  using Call = void (*)(void* body, std::size_t begin, std::size_t end, unsigned worker);
  void run(std::size_t count, std::size_t grain, Call call, void* body);

  struct Threads;
  unsigned threads_;
  std::unique_ptr<Threads> pool_;
};

}  // namespace cohort
