#include "tools/cohort/terminal.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>

namespace cohort::tool {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr std::chrono::seconds line_interval{2};            // where lines cannot be rewritten
constexpr std::chrono::milliseconds worth_mentioning{300};  // a wait

double seconds(std::chrono::nanoseconds duration) { return Seconds(duration).count(); }

std::string awaited_text(const session::Progress& progress) {
  std::string text = "waiting for " + progress.awaited.front();
  if (progress.awaited.size() > 1) text += fmt::format(" and {} more", progress.awaited.size() - 1);
  if (!progress.awaited_from.empty()) text += ": " + progress.awaited_from;
  return text;
}

std::string microseconds(std::chrono::nanoseconds duration) {
  return fmt::format("{:.0f}", std::chrono::duration<double, std::micro>(duration).count());
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

Terminal::Terminal(bool quiet) : quiet_(quiet), in_place_(isatty(STDERR_FILENO) != 0) {}

Terminal::~Terminal() { clear_line(); }

void Terminal::clear_line() {
  if (!line_open_) return;
  std::fputs("\r\033[K", stderr);
  line_open_ = false;
}

void Terminal::progress(const session::Progress& progress) {
  if (quiet_) return;
  const bool waits = !progress.awaited.empty() && (!progress.started || progress.waiting > worth_mentioning);
  const std::string awaited = waits ? awaited_text(progress) : std::string();
  std::string line;
  if (progress.started)
    line = fmt::format("{:8.2f} of {:.2f} s simulated   {:6.1f} x real time", seconds(progress.time),
                       seconds(progress.duration), progress.real_time_factor);
  if (waits) line += (line.empty() ? "" : "   ") + awaited;
  if (waits && progress.started) line += fmt::format(", {:.1f} s", seconds(progress.waiting));

  if (in_place_) {
    clear_line();
    std::fputs(line.c_str(), stderr);
    line_open_ = true;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const bool news = awaited != last_awaited_ && waits;
  last_awaited_ = awaited;
  if (!news && now - last_line_ < line_interval) return;
  last_line_ = now;
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Terminal::event(const session::Event& event) {
  if (quiet_) return;
  clear_line();
  // A resent frame may be answered twice.
  const bool answered_twice =
      event.kind == "rejected" && (event.text.starts_with("repeated") || event.text.starts_with("stale"));
  const bool expected = event.kind == "joined" || event.kind == "back" || answered_twice;
  spdlog::log(expected ? spdlog::level::info : spdlog::level::warn, "tick {}: {}: {}", event.tick, event.kind,
              event.text);
}

void Terminal::say(const std::string& line) {
  if (quiet_) return;
  clear_line();
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Terminal::summary(const session::RunResult& result, double cpu_seconds) {
  if (quiet_) return;
  clear_line();
  const double wall = seconds(result.wall_time);
  std::printf("ticks             %lu (%.2f s simulated, %u robots)\n", static_cast<unsigned long>(result.ticks),
              seconds(result.sim_time), result.robots);
  std::printf("real-time factor  %.1f (%.2f s wall, %.2f s CPU)\n", wall > 0.0 ? seconds(result.sim_time) / wall : 0.0,
              wall, cpu_seconds);
  std::printf("barrier latency   p50 %s us, p99 %s us, max %s us\n", microseconds(result.barrier.quantile(0.5)).c_str(),
              microseconds(result.barrier.quantile(0.99)).c_str(), microseconds(result.barrier.max()).c_str());
  std::printf("contacts          obstacles in %.2f %% of robot-ticks, other robots in %.2f %%\n",
              percent(result.touches.obstacles, result.touches.robot_ticks),
              percent(result.touches.robots, result.touches.robot_ticks));
  if (result.late > 0) std::printf("late answers      %lu\n", static_cast<unsigned long>(result.late));
  std::printf("state hash        %016lx\n", static_cast<unsigned long>(result.state_hash));
  std::fflush(stdout);
}

}  // namespace cohort::tool
