// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/ctl/ctl_status.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

std::string speed_text(double speed) { return speed == 0.0 ? "max" : fmt::format("{:g}", speed); }

// Returns the selector of these ids, such as `0..3,7`.
std::string ranges_of(const std::vector<std::uint32_t>& ids) {
  std::string text;
  for (std::size_t i = 0; i < ids.size();) {
    std::size_t end = i + 1;
    while (end < ids.size() && ids[end] == ids[end - 1] + 1) ++end;
    if (!text.empty()) text += ",";
    text += std::to_string(ids[i]);
    if (end > i + 1) text += ".." + std::to_string(ids[end - 1]);
    i = end;
  }
  return text;
}

std::string awaited_text(const SimulationStatus& status) {
  if (status.awaited.empty()) return {};
  std::string text = "waiting for " + status.awaited.front();
  if (status.awaited_count > 1) text += fmt::format(" and {} more", status.awaited_count - 1);
  for (const ControllerStatus& each : status.controllers)
    if (each.awaited) return text + fmt::format(": {}, {:.1f} s", each.label, seconds(status.waiting));
  return text;
}

}  // namespace

std::string word_of(SimulationState state) {
  switch (state) {
    case SimulationState::stopped: return "stopped";
    case SimulationState::playing: return "playing";
    case SimulationState::paused: return "paused";
    case SimulationState::quitting: return "quitting";
  }
  return "in state " + std::to_string(static_cast<std::uint32_t>(state));
}

std::string status_text(const SimulationStatus& status) {
  std::string text = fmt::format("{}   {}   run {}, seed {}   {}\n", status.experiment, word_of(status.state),
                                 status.run, status.seed, counted(status.robots, "robot"));
  text += fmt::format("tick {}   {:.2f}{} s simulated   {:.2f} x real time (speed {})   hash {:016x}\n", status.tick,
                      seconds(status.time), of_duration(status.duration), status.real_time_factor,
                      speed_text(status.speed), status.state_hash);
  if (const std::string awaited = awaited_text(status); !awaited.empty()) text += awaited + "\n";
  if (status.controllers.empty()) return text + "no controller\n";
  std::size_t width = 10;
  for (const ControllerStatus& each : status.controllers) width = std::max(width, each.label.size());
  text += fmt::format("\n{:<{}}  {:<14} {:>10} {:>9} {:>7} {:>9} {:>9} {:>9} {:>7}\n", "controller", width, "robots",
                      "due tick", "awaited", "late", "p50 us", "p99 us", "rejected", "resent");
  for (const ControllerStatus& each : status.controllers)
    text += fmt::format("{:<{}}  {:<14} {:>10} {:>9} {:>7} {:>9.0f} {:>9.0f} {:>9} {:>7}{}\n", each.label, width,
                        ranges_of(each.robots), each.due_tick,
                        each.awaited ? fmt::format("{:.1f} s", seconds(each.awaiting)) : "-", each.late,
                        microseconds(each.answer_p50), microseconds(each.answer_p99), each.rejected, each.resent,
                        each.alive ? "" : "  gone or not responding");
  return text;
}

std::string status_json(const SimulationStatus& status, int indent) {
  nlohmann::ordered_json json = {{"state", word_of(status.state)},
                                 {"run", status.run},
                                 {"tick", status.tick},
                                 {"sim_time_ns", status.time.count()}};
  nlohmann::ordered_json controllers = nlohmann::ordered_json::array();
  for (const ControllerStatus& each : status.controllers)
    controllers.push_back(
        {{"label", each.label},
         {"client", fmt::format("{:016x}", each.client)},
         {"robots", each.robots},
         {"alive", each.alive},
         {"awaited", each.awaited},
         {"awaited_s", seconds(each.awaiting)},
         {"due_tick", each.due_tick},
         {"answers", each.answers},
         {"late", each.late},
         {"rejected", each.rejected},
         {"resent", each.resent},
         {"answer_us", {{"p50", microseconds(each.answer_p50)}, {"p99", microseconds(each.answer_p99)}}}});
  json.update(nlohmann::ordered_json{{"experiment", status.experiment},
                                     {"seed", status.seed},
                                     {"started", status.started},
                                     {"step_ns", status.step.count()},
                                     {"duration_ns", status.duration.count()},
                                     {"speed", status.speed},
                                     {"real_time_factor", status.real_time_factor},
                                     {"state_hash", fmt::format("{:016x}", status.state_hash)},
                                     {"robots", status.robots},
                                     {"awaited", status.awaited},
                                     {"awaited_count", status.awaited_count},
                                     {"waiting_s", seconds(status.waiting)},
                                     {"controllers", controllers}});
  return json_text(json, indent) + "\n";
}

}  // namespace cohort::tool
