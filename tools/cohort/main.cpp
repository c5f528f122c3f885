#include <string>
#include <string_view>

#include "client_sdk/src/program.hpp"
#include "idl/wire.hpp"
#include "tools/cohort/cli/build_facts.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace {

using namespace cohort::tool;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one log for the process.
Log* dds_log = nullptr;

void log_dds_to(Log& log) {
  dds_log = &log;
  cohort::wire::set_dds_log([](std::string_view message, cohort::wire::DdsLogKind kind) noexcept {
    using cohort::wire::DdsLogKind;
    if (kind == DdsLogKind::refusal) return dds_log->warning(std::string(message));
    dds_log->write(kind == DdsLogKind::fatal ? LogLevel::error : LogLevel::debug, "dds: " + std::string(message));
  });
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line("Cohort: a deterministic simulator for groups of robots", "cohort");
  line.set_version(version_text, "Print the version, and how this was built");
  line.set_help("Print this text and exit");
  line.require_subcommand();
  LogFlags flags;
  add_log_flags(line, flags);
  line.footer(
      "Example: cohort run worlds/experiments/obstacle_avoidance.yaml --duration 10\n"
      "'cohort COMMAND --help' says more, 'cohort help' what may be written in files. Exit codes: 0 done, 1 the run "
      "failed, 2 a mistake in the command line, the\n"
      "files or the set-up, 130 interrupted.");
  const std::vector<Subcommand> commands = add_commands(line, flags);

  LogOptions options;
  try {
    if (!line.parse(argc, argv)) return exit_ok;
    options = log_options(flags);
  } catch (const UsageError& error) {
    Log({.format = format_of_unreadable(argc, argv)}).error(error.what());
    return exit_usage;
  }
  Log log(options);
  log_dds_to(log);
  return run_chosen(commands, log, cohort::stop_on_signals());
}
