#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "server/core/processors.hpp"
#include "server/recording/difference.hpp"
#include "tools/cohort/cli/shown.hpp"
#include "tools/cohort/cli/terminal/replay_progress.hpp"
#include "tools/cohort/cli/wording.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {
namespace {

struct DiffCommand {
  std::filesystem::path first;
  std::filesystem::path second;
  bool json = false;
};

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
    return show(fmt::format("{}; until then they are identical, {}\n", found.ends, counted(found.boundaries, "tick")));
  fmt::print("they part at tick {} ({:.3f} s), after {}\n", found.parting->tick,
             Seconds(found.parting->log_time).count(), counted(found.boundaries, "identical tick"));
  for (const auto& difference : found.parting->differences) show(line_of(difference) + "\n");
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
  show(json_text(json, 2) + "\n");
}

int diff(const DiffCommand& command, Log& log, const std::atomic<bool>& stop) {
  const recording::Recording first(command.first);
  const recording::Recording second(command.second);
  for (const recording::Recording* each : {&first, &second})
    if (!each->damage().empty()) log.warning(each->damage());
  const std::uint64_t first_seed = first.worlds().front().begins.seed;
  const std::uint64_t second_seed = second.worlds().front().begins.seed;
  if (first_seed != second_seed)
    log.warning(fmt::format("their seeds are {} and {}, so they part where the first random number is used", first_seed,
                            second_seed));
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
}

}  // namespace

Subcommand add_diff(CommandLine app) {
  const auto command = std::make_shared<DiffCommand>();
  CommandLine line = app.add_subcommand("diff", "Find where two recorded runs part, and in what");
  line.add_option("FIRST", command->first, "Recording (MCAP)").required().type_name("");
  line.add_option("SECOND", command->second, "Another one").required().type_name("");
  line.add_flag("--json", command->json, "Print it as JSON");
  line.footer("Example: cohort diff monday.mcap tuesday.mcap");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return diff(*command, log, stop); }};
}

}  // namespace cohort::tool
