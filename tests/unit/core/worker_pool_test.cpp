// SPDX-License-Identifier: Apache-2.0
#include "server/core/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/support/patience.hpp"

namespace cohort {
namespace {

TEST(WorkerPool, CoversEveryIndexOnceInChunksIndependentOfThreads) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    WorkerPool workers(threads);
    std::vector<std::atomic<int>> visits(1003);
    workers.for_each_chunk(visits.size(), 10, [&](std::size_t begin, std::size_t end, unsigned worker) {
      EXPECT_EQ(begin % 10, 0u);
      EXPECT_LE(end - begin, 10u);
      EXPECT_LT(worker, threads);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(WorkerPool, RefusesNumbersOfThreadsThatNoMachineHas) {
  EXPECT_THROW(WorkerPool(0), std::invalid_argument);
  EXPECT_THROW(WorkerPool(1'000'000), std::invalid_argument);
}

TEST(WorkerPool, PassesAnExceptionOn) {
  WorkerPool workers(2);
  EXPECT_THROW(workers.for_each_chunk(100, 1,
                                      [](std::size_t begin, std::size_t, unsigned) {
                                        if (begin == 50) throw std::runtime_error("no");
                                      }),
               std::runtime_error);
}

// How many are at work at once, waiting for each other until there are as many as the pool has threads.
unsigned workers_at_once(WorkerPool& pool) {
  std::vector<std::atomic<bool>> is_at_work(pool.threads());
  std::atomic<unsigned> at_work = 0;
  std::atomic<bool> in_vain = false;
  pool.for_each_chunk(64, 1, [&](std::size_t, std::size_t, unsigned worker) {
    if (!is_at_work[worker].exchange(true)) ++at_work;
    if (!test::eventually([&] { return at_work == pool.threads() || in_vain; })) in_vain = true;
  });
  return at_work;
}

TEST(WorkerPool, HasAllItsThreadsBesideASmallerPool) {
  WorkerPool of_two(2);
  WorkerPool of_four(4);
  EXPECT_EQ(workers_at_once(of_four), 4u);
  EXPECT_EQ(workers_at_once(of_two), 2u);
}

TEST(WorkerPool, WorksConcurrentlyWithAnotherPool) {
  WorkerPool of_two(2);
  WorkerPool of_three(3);
  unsigned there = 0;
  std::thread other([&] { there = workers_at_once(of_three); });
  EXPECT_EQ(workers_at_once(of_two), 2u);
  other.join();
  EXPECT_EQ(there, 3u);
}

}  // namespace
}  // namespace cohort
