#include "server/core/tbb_loop.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace cohort {

namespace {

// Allows more threads than cores, which oneTBB does not by default. The least of all limits in a process counts, so
// there is a single one for the life of the process. The number of threads of a loop depends on its arena.
void allow_more_threads_than_cores() {
  constexpr std::size_t more_than_any_pool = 4096;
  [[maybe_unused]] static const auto* const allowance =
      new tbb::global_control(tbb::global_control::max_allowed_parallelism, more_than_any_pool);
}

}  // namespace

struct TbbLoop::Threads {
  explicit Threads(unsigned count) : arena(static_cast<int>(count)) { allow_more_threads_than_cores(); }

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
