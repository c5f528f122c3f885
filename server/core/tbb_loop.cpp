#include "server/core/tbb_loop.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace cohort {

struct TbbLoop::Threads {
  explicit Threads(unsigned count)
      : allowance(tbb::global_control::max_allowed_parallelism, count), arena(static_cast<int>(count)) {}

  tbb::global_control allowance;  // oneTBB starts no more threads than cores without it
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
