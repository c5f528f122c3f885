#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace cohort {

/// The threads of one simulation, over oneTBB. A loop runs in chunks whose bounds depend on `count` and `grain` alone;
/// results are deterministic as long as a chunk writes only what belongs to its indices (and to its worker's scratch
/// memory, which must not carry over from one chunk to the next).
class WorkerPool {
 public:
  /// `threads` >= 1, the caller's included; may exceed the number of cores.
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();

  unsigned threads() const { return threads_; }

  /// Calls `body(begin, end, worker)` for chunks of at most `grain` indices that cover [0, count); returns when all are
  /// done. `worker` < threads(), and no two chunks run at once with the same one. An exception is passed on. One loop
  /// at a time: not from inside a chunk, nor from two threads.
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
