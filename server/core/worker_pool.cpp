#include "server/core/worker_pool.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

namespace cohort {

struct WorkerPool::Threads {
  explicit Threads(unsigned count)
      : allowance(tbb::global_control::max_allowed_parallelism, count),
        arena(static_cast<int>(count)),
        handed_over(count) {}

  tbb::global_control allowance;  // oneTBB starts no more threads than cores without it
  tbb::task_arena arena;
  // What oneTBB guarantees already, said once more so that ThreadSanitizer, which cannot see into it, knows too: chunks
  // come after the loop's begin, its end after them, and chunks with one worker's scratch memory after each other.
  std::atomic<std::size_t> begun = 0;
  std::atomic<std::size_t> done = 0;
  std::vector<std::atomic<std::size_t>> handed_over;  // by worker
};

WorkerPool::WorkerPool(unsigned threads) : threads_(threads) {
  if (threads == 0) throw std::invalid_argument("a worker pool needs at least one thread");
  if (threads > 1) pool_ = std::make_unique<Threads>(threads);
}

WorkerPool::~WorkerPool() = default;

void WorkerPool::run(std::size_t count, std::size_t grain, Call call, void* body) {
  if (!pool_ || count <= grain) {
    for (std::size_t begin = 0; begin < count; begin += grain) call(body, begin, std::min(count, begin + grain), 0);
    return;
  }
  const std::size_t chunks = (count + grain - 1) / grain;
  pool_->begun.fetch_add(1, std::memory_order_release);
  pool_->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      const auto worker = static_cast<unsigned>(tbb::this_task_arena::current_thread_index());
      pool_->begun.load(std::memory_order_acquire);
      pool_->handed_over[worker].load(std::memory_order_acquire);
      const std::size_t begin = chunk * grain;
      call(body, begin, std::min(count, begin + grain), worker);
      pool_->handed_over[worker].fetch_add(1, std::memory_order_release);
      pool_->done.fetch_add(1, std::memory_order_release);
    });
  });
  pool_->done.load(std::memory_order_acquire);
}

}  // namespace cohort
