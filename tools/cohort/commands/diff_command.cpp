#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "server/core/processors.hpp"
#include "server/recording/difference.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/cli/replay_progress.hpp"
#include "tools/cohort/cli/wording.hpp"

namespace cohort::tool {
namespace {

using Seconds = std::chrono::duration<double>;

std::string line_of(const recording::QuantityDifference& difference) {
  std::string values = difference.first;
  if (!difference.second.empty()) values += " | " + difference.second;
  return fmt::format("  {:<12} {:<24} {}: {}", difference.quantity,
                     difference.object.empty() ? "the world" : difference.object, difference.detail, values);
}

void print_text(const recording::Comparison& found) {
  if (!found.parting && found.ends.empty()) return fmt::print("identical, {}\n", counted(found.boundaries, "tick"));
  if (!found.parting)
    return fmt::print("{}; until then they are identical, {}\n", found.ends, counted(found.boundaries, "tick"));
  fmt::print("they part at tick {} ({:.3f} s), after {}\n", found.parting->tick,
             Seconds(found.parting->log_time).count(), counted(found.boundaries, "identical tick"));
  for (const auto& difference : found.parting->differences) fmt::print("{}\n", line_of(difference));
  if (found.parting->more > 0) fmt::print("  and {} more\n", found.parting->more);
}

void print_json(const recording::Comparison& found) {
  nlohmann::ordered_json json = {{"identical_ticks", found.boundaries},
                                 {"identical", !found.parting && found.ends.empty()}};
  if (!found.ends.empty()) json["ends"] = found.ends;
  if (found.parting) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& each : found.parting->differences)
      list.push_back({{"object", each.object},
                      {"quantity", each.quantity},
                      {"detail", each.detail},
                      {"first", each.first},
                      {"second", each.second}});
    json["tick"] = found.parting->tick;
    json["time_s"] = Seconds(found.parting->log_time).count();
    json["differences"] = list;
    json["more"] = found.parting->more;
  }
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

int diff(const DiffCommand& command, Log& log, const std::atomic<bool>& stop) {
  try {
    const recording::Recording first(command.first);
    const recording::Recording second(command.second);
    for (const recording::Recording* each : {&first, &second})
      if (!each->damage().empty()) log.warning(each->damage());
    ReplayProgress progress(log);
    const recording::Comparison found =
        recording::compare(first, second, available_processors(), [&](std::chrono::nanoseconds log_time) {
          progress.at(log_time, "compared");
          return !stop;
        });
    log.clear_progress();
    if (stop) return exit_interrupted;
    if (command.json)
      print_json(found);
    else
      print_text(found);
    return found.parting || !found.ends.empty() ? exit_failed : exit_ok;
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
