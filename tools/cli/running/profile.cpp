// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

double per(double sum, std::uint64_t count) { return count > 0 ? sum / static_cast<double>(count) : 0.0; }

}  // namespace

std::string profile_text(const session::RunResult& result, const StageTimes& times) {
  std::string text = "profile           wall time a tick, and its share\n";
  const auto add = [&](std::string_view name, std::chrono::nanoseconds time) {
    const double share = result.wall_time.count() > 0 ? seconds(time) / seconds(result.wall_time) : 0.0;
    text += fmt::format("  {:<26}{:10.1f} us {:6.1f} %\n", name, per(1e6 * seconds(time), result.ticks), 1e2 * share);
  };
  std::chrono::nanoseconds rest = result.wall_time - result.barrier.sum();
  add("controllers", result.barrier.sum());
  for (const StageTimes::Stage& stage : times.stages()) {
    add(stage.name, stage.time);
    rest -= stage.time;
  }
  add("recording and the rest", std::max(rest, std::chrono::nanoseconds{0}));
  const physics::Convergence& solver = result.convergence;
  if (solver.solved == 0) return text;
  const auto mean = [&](std::uint64_t sum) { return per(static_cast<double>(sum), solver.solved); };
  return text + fmt::format(
                    "solver            {:.1f} groups a tick; for a group {:.1f} minima (at most {}), {:.1f} steps, "
                    "{:.1f} factorisations\n",
                    per(static_cast<double>(solver.solved), result.ticks), mean(solver.minima), solver.most_minima,
                    mean(solver.steps), mean(solver.factorisations));
}

}  // namespace cohort::tool
