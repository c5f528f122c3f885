#include "tools/cohort/commands/commands.hpp"

#include <algorithm>

#include "server/description/input_error.hpp"

namespace cohort::tool {

std::vector<Subcommand> add_commands(CommandLine app, LogFlags& flags) {
  std::vector<Subcommand> commands;
  for (const auto add : {add_run, add_serve, add_host}) commands.push_back(add(app, flags));
  for (const auto add : {
           add_teleop,
           add_ctl,
           add_record,
           add_view,
           add_check,
           add_export,
           add_samples,
           add_security,
           add_doctor,
           add_replay,
           add_diff,
           add_export_data,
           add_plot,
           add_recover,
           add_help,
           add_completion,
           add_man_page,
           add_bench,
       }) {
    commands.push_back(add(app));
    add_log_flags(commands.back().line, flags);
  }
  return commands;
}

int run_chosen(const std::vector<Subcommand>& commands, Log& log, const std::atomic<bool>& stop) {
  const auto chosen = std::ranges::find_if(commands, [](const Subcommand& each) { return each.line.parsed(); });
  try {
    return chosen->run(log, stop);
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
