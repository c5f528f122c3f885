#include "tools/cohort/summary_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/cohort/output_file.hpp"

namespace cohort::tool {
namespace {

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }
double microseconds(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

}  // namespace

void write_summary(const std::filesystem::path& file, const session::RunResult& result, double cpu_seconds) {
  const double wall = seconds(result.wall_time);
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const session::Event& event : result.events)
    events.push_back({{"tick", event.tick}, {"kind", event.kind}, {"text", event.text}, {"count", event.count}});
  const nlohmann::ordered_json summary = {
      {"ticks", result.ticks},
      {"sim_time_ns", result.sim_time.count()},
      {"wall_s", wall},
      {"cpu_s", cpu_seconds},
      {"real_time_factor", wall > 0.0 ? seconds(result.sim_time) / wall : 0.0},
      {"state_hash", fmt::format("{:016x}", result.state_hash)},
      {"robots", result.robots},
      {"barrier_us",
       {{"p50", microseconds(result.barrier.quantile(0.5))},
        {"p99", microseconds(result.barrier.quantile(0.99))},
        {"max", microseconds(result.barrier.max())}}},
      {"late", result.late},
      {"events", events},
      {"stop_reason", result.stop_reason},
      {"touches",
       {{"robot_ticks", result.touches.robot_ticks},
        {"obstacles", result.touches.obstacles},
        {"robots", result.touches.robots}}},
  };
  write_file("the summary", file, summary.dump(2) + "\n");
}

}  // namespace cohort::tool
