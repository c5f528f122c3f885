// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/terminal/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "idl/include/cohort/version.h"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr std::chrono::seconds line_interval{2};            // interval of lines that cannot be rewritten
constexpr std::chrono::milliseconds worth_mentioning{300};  // shortest wait that is reported

std::string awaited_text(const session::Progress& progress) {
  std::string text = "waiting for " + progress.awaited.front();
  if (progress.awaited.size() > 1) text += fmt::format(" and {} more", progress.awaited.size() - 1);
  if (!progress.awaited_from.empty()) text += ": " + progress.awaited_from;
  return text;
}

std::string whole_microseconds(std::chrono::nanoseconds duration) {
  return fmt::format("{:.0f}", microseconds(duration));
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

// Models without devices are not robots; they are counted if there is no robot.
std::string counted_objects(const description::World& world, std::uint32_t robots) {
  if (robots > 0) return counted(robots, "robot");
  const auto moving = static_cast<std::size_t>(std::ranges::count_if(
      world.instances, [&](const description::Instance& object) { return !world.models[object.model].is_static; }));
  return moving > 0 ? counted(moving, "model") : counted(world.instances.size(), "static model");
}

std::string quantiles_text(const lockstep::LatencyHistogram& latencies) {
  return fmt::format("p50 {} us, p99 {} us, max {} us", whole_microseconds(latencies.quantile(0.5)),
                     whole_microseconds(latencies.quantile(0.99)), whole_microseconds(latencies.max()));
}

// Measurements of the exchange with controllers are for those who ask, or whose controllers were late.
std::string exchange_text(const session::RunResult& result) {
  std::string text;
  if (result.robots > 0) text += fmt::format("barrier latency   {}\n", quantiles_text(result.barrier));
  if (result.repeated > 0)
    text += fmt::format("repeated answers  {}, ignored; {} frames were sent again\n", result.repeated, result.resent);
  return text;
}

std::string summary_text(const description::Experiment& experiment, const session::RunResult& result,
                         double cpu_seconds, bool is_verbose) {
  const double wall = seconds(result.wall_time);
  std::string text =
      fmt::format("experiment        {}, seed {} (Cohort {})\n", experiment.name, experiment.seed, COHORT_VERSION);
  text += fmt::format("ticks             {} ({:.2f} s simulated, {})\n", result.ticks, seconds(result.sim_time),
                      counted_objects(experiment.world, result.robots));
  if (!result.stop_reason.empty()) text += fmt::format("stopped           by {}\n", result.stop_reason);
  if (experiment.world.replaced_meshes > 0)
    text += fmt::format("missing meshes    {}\n", experiment.world.replaced_meshes);
  if (!result.unrecorded.empty()) text += fmt::format("recording         INCOMPLETE: {}\n", result.unrecorded);
  text += fmt::format("real-time factor  {:.1f} ({:.2f} s wall, {:.2f} s CPU)\n",
                      wall > 0.0 ? seconds(result.sim_time) / wall : 0.0, wall, cpu_seconds);
  if (result.lateness.count() > 0)
    text += fmt::format("tick lateness     {}; longer than a step in {:.2f} % of ticks\n",
                        quantiles_text(result.lateness), percent(result.late_ticks, result.lateness.count()));
  if (result.robots > 0)
    text += fmt::format("contacts          obstacles in {:.2f} % of robot-ticks, other robots in {:.2f} %\n",
                        percent(result.touches.obstacles, result.touches.robot_ticks),
                        percent(result.touches.robots, result.touches.robot_ticks));
  if (result.convergence.unconverged > 0)
    text += fmt::format("convergence       {} of {} groups solved with an error above {:.0e}, at most {:.0e}\n",
                        result.convergence.unconverged, result.convergence.solved, physics::Convergence::bound,
                        result.convergence.worst);
  if (result.late > 0) text += fmt::format("late answers      {}\n", result.late);
  if (is_verbose || result.late > 0) text += exchange_text(result);
  return text + fmt::format("state hash        {:016x}\n", result.state_hash);
}

}  // namespace

void Terminal::progress(const session::Progress& progress) {
  if (!options_.shows_progress) return;
  const bool waits = !progress.awaited.empty() && (!progress.started || progress.waiting > worth_mentioning);
  const std::string awaited = waits ? awaited_text(progress) : std::string();
  std::string line;
  // Fixed columns keep the line in place while its numbers change.
  if (progress.started)
    line = fmt::format(fmt::runtime(log_.format() == LogFormat::text ? "{:8.2f}{} s simulated   {:6.1f} x real time"
                                                                     : "{:.2f}{} s simulated, {:.1f} x real time"),
                       seconds(progress.time), of_duration(progress.duration), progress.real_time_factor);
  if (progress.unrecorded) line += log_.format() == LogFormat::text ? "   NOT RECORDED" : ", no longer recorded";
  if (waits) line += (line.empty() ? "" : log_.format() == LogFormat::text ? "   " : ", ") + awaited;
  if (progress.paused) line += log_.format() == LogFormat::text ? "   paused" : ", paused";
  if (waits && progress.started) line += fmt::format(", {:.1f} s", seconds(progress.waiting));

  if (line.empty()) return log_.clear_progress();
  const auto now = std::chrono::steady_clock::now();
  const bool news =
      (awaited != last_awaited_ && waits) || progress.paused != was_paused_ || progress.unrecorded != was_unrecorded_;
  last_awaited_ = awaited;
  was_paused_ = progress.paused;
  was_unrecorded_ = progress.unrecorded;
  if (!log_.rewrites_progress() && !news && now - last_line_ < line_interval) return;
  last_line_ = now;
  LogFields fields = {{"sim_time_s", seconds(progress.time)}, {"duration_s", seconds(progress.duration)}};
  if (progress.started) fields.emplace_back("real_time_factor", progress.real_time_factor);
  if (progress.paused) fields.emplace_back("paused", true);
  if (progress.unrecorded) fields.emplace_back("unrecorded", true);
  if (waits) fields.emplace_back("waiting_for", progress.awaited);
  log_.progress(line, fields);
}

void Terminal::event(const session::RunEvent& event) {
  log_.write(level_of(event), fmt::format("tick {}: {}: {}", event.tick, event.kind, event.text),
             {{"tick", event.tick}, {"kind", event.kind}});
}

// Events that the final error repeats, and events of normal operation, have the level `info`.
LogLevel Terminal::level_of(const session::RunEvent& event) {
  const std::string& kind = event.kind;
  if (kind == "event" || kind == "joined" || kind == "back" || kind == "superseded" || kind == "failed" ||
      kind == "control" || kind == "stopped")
    return LogLevel::info;
  if (kind == "lost" && options_.own_controllers) return LogLevel::info;
  if (kind == "unrecorded") return LogLevel::error;
  // Once for each controller, also if the run goes on from several snapshots.
  if (kind == "unsaved" && !unsaved_told_.insert(event.text).second) return LogLevel::info;
  // The summary counts them.
  if (kind == "missed" && std::exchange(miss_was_told_, true)) return LogLevel::info;
  return LogLevel::warning;
}

void Terminal::summary(const description::Experiment& experiment, const session::RunResult& result, double cpu_seconds,
                       std::FILE* stream) {
  log_.info(result.end == session::RunResult::End::finished ? "the run has finished" : "the run has ended early",
            {{"ticks", result.ticks}, {"state_hash", fmt::format("{:016x}", result.state_hash)}});
  log_.clear_progress();
  if (options_.quiet || (stream == stderr && log_.format() == LogFormat::json)) return;
  const std::string text = summary_text(experiment, result, cpu_seconds, log_.shows(LogLevel::info));
  if (stream == stderr) {
    std::fputs(printable(text, std::string::npos, Lines::kept).c_str(), stderr);
  } else {
    show(text);
    flush_output();
  }
}

}  // namespace cohort::tool
