// SPDX-License-Identifier: Apache-2.0
#include "server/core/tbb_loop.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <new>
#include <thread>

#include "server/core/thread_room.hpp"

namespace cohort {

namespace {

// Allows more threads than cores, which oneTBB does not by default. The least of all limits in a process counts, so
// there is a single one for the life of the process. The number of threads of a loop depends on its arena.
void allow_more_threads_than_cores() {
  constexpr std::size_t more_than_any_pool = 4096;
  alignas(tbb::global_control) static std::array<std::byte, sizeof(tbb::global_control)> memory;
  [[maybe_unused]] static const auto* const allowance =
      new (memory.data()) tbb::global_control(tbb::global_control::max_allowed_parallelism, more_than_any_pool);
}

// Occupies all threads of the arena at once, so that oneTBB starts them. On a very busy machine, some may start later.
void occupy_all(tbb::task_arena& arena, unsigned count) {
  constexpr std::chrono::seconds patience{1};
  const auto end = std::chrono::steady_clock::now() + patience;
  std::atomic<unsigned> arrived{0};
  arena.execute([&] {
    tbb::parallel_for(
        0U, count,
        [&](unsigned) {
          ++arrived;
          while (arrived < count && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        },
        tbb::simple_partitioner());
  });
}

// Starts the threads of oneTBB that are missing. By itself, oneTBB starts them when a loop has work for them, and ends
// the process if it cannot.
void start_threads(tbb::task_arena& arena, unsigned count) {
  static std::mutex mutex;
  static unsigned started = 1;  // with the caller's, which is in every arena
  const std::lock_guard lock(mutex);
  if (count <= started) return;
  expect_room_for_threads(count - started);
  occupy_all(arena, count);
  started = count;
}

}  // namespace

struct TbbLoop::Threads {
  explicit Threads(unsigned count) : arena(static_cast<int>(count)) {
    allow_more_threads_than_cores();
    start_threads(arena, count);
  }

  tbb::task_arena arena;
};

TbbLoop::TbbLoop(unsigned threads) : threads_(std::make_unique<Threads>(threads)) {}

TbbLoop::~TbbLoop() = default;

void TbbLoop::run(std::size_t count, Call call, void* argument) {
  threads_->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t index) {
      call(argument, index, static_cast<unsigned>(tbb::this_task_arena::current_thread_index()));
    });
  });
}

}  // namespace cohort
