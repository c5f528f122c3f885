// SPDX-License-Identifier: Apache-2.0
#include "server/core/worker_pool.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/core/tbb_loop.hpp"

namespace cohort {

struct WorkerPool::Threads {
  explicit Threads(unsigned thread_count) : loop(thread_count), handed_over(thread_count) {}

  void run_chunk(std::size_t chunk, unsigned worker) {
    begun.load(std::memory_order_acquire);
    handed_over[worker].load(std::memory_order_acquire);
    const std::size_t begin = chunk * grain;
    call(body, begin, std::min(count, begin + grain), worker);
    handed_over[worker].fetch_add(1, std::memory_order_release);
    done.fetch_add(1, std::memory_order_release);
  }

  TbbLoop loop;

  // The current loop.
  std::size_t count = 0;
  std::size_t grain = 1;
  Call call = nullptr;
  void* body = nullptr;

  // Repeats the ordering guarantees of oneTBB for ThreadSanitizer, which cannot see into it. Chunks run after the start
  // of the loop and before its end, and chunks with the same worker's scratch memory run one after the other.
  std::atomic<std::size_t> begun = 0;
  std::atomic<std::size_t> done = 0;
  std::vector<std::atomic<std::size_t>> handed_over;  // by worker
};

WorkerPool::WorkerPool(unsigned threads) : threads_(threads) {
  constexpr unsigned most_threads = 1024;
  if (threads == 0 || threads > most_threads)
    throw std::invalid_argument("the number of threads is " + std::to_string(threads) + ", expected 1 to " +
                                std::to_string(most_threads));
  if (threads > 1) pool_ = std::make_unique<Threads>(threads);
}

WorkerPool::~WorkerPool() = default;

void WorkerPool::run(std::size_t count, std::size_t grain, Call call, void* body) {
  assert(grain > 0);
  if (!pool_ || count <= grain) {
    for (std::size_t begin = 0; begin < count; begin += grain) call(body, begin, std::min(count, begin + grain), 0);
    return;
  }
  pool_->count = count;
  pool_->grain = grain;
  pool_->call = call;
  pool_->body = body;
  pool_->begun.fetch_add(1, std::memory_order_release);
  pool_->loop.run(
      (count + grain - 1) / grain,
      [](void* pool, std::size_t chunk, unsigned worker) { static_cast<Threads*>(pool)->run_chunk(chunk, worker); },
      pool_.get());
  pool_->done.load(std::memory_order_acquire);
}

}  // namespace cohort
