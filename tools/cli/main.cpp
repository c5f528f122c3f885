#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/standard_streams.hpp"
#include "idl/dds/transport.hpp"
#include "server/core/atomic_file.hpp"
#include "server/core/thread_room.hpp"
#include "server/description/input_error.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/build_facts.hpp"
#include "tools/cli/common/output_file.hpp"

namespace {

using namespace cohort::tool;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one log for the process.
Log* dds_log = nullptr;

void log_dds_to(Log& log) {
  dds_log = &log;
  cohort::wire::set_dds_log([](std::string_view message, cohort::wire::DdsLogKind kind) noexcept {
    using cohort::wire::DdsLogKind;
    if (kind == DdsLogKind::refusal) return dds_log->warning(std::string(message));
    if (kind != DdsLogKind::fatal) return dds_log->debug("dds: " + std::string(message));
    // Cyclone ends the process after this message.
    if (message.find("ddsrt_thread_create failed") != std::string_view::npos) {
      dds_log->error(cohort::ThreadLimit("a thread of DDS").what());
      std::_Exit(exit_failed);
    }
    dds_log->error("dds: " + std::string(message));
  });
}

// Returns the commands in the order of help. `flags` must outlive `app`.
std::vector<Subcommand> add_commands(CommandLine app, LogFlags& flags) {
  std::vector<Subcommand> commands;
  for (const auto add : {add_run, add_serve, add_host}) commands.push_back(add(app, flags));
  for (const auto add : {
           add_teleop,   add_exec,     add_ctl,        add_record,     add_view,     add_page,
           add_film,     add_examples, add_check,      add_export,     add_models,   add_samples,
           add_security, add_doctor,   add_recordings, add_replay,     add_diff,     add_export_data,
           add_plot,     add_recover,  add_help,       add_completion, add_man_page, add_bench,
       }) {
    commands.push_back(add(app));
    add_log_flags(commands.back().line, flags);
  }
  return commands;
}

// Runs the selected command and logs its exceptions. Returns the exit code.
int run_chosen(const std::vector<Subcommand>& commands, Log& log, const std::atomic<bool>& stop) {
  const auto chosen = std::ranges::find_if(commands, [](const Subcommand& each) { return each.line.parsed(); });
  try {
    return chosen->run(log, stop);
  } catch (const cohort::description::InputError& error) {
    log.problems(error);
  } catch (const cohort::WriteError& error) {
    log.error(error.what());
    return exit_failed;
  } catch (const std::bad_alloc& error) {
    log.error(text_of(error));
    return exit_failed;
  } catch (const std::exception& error) {
    log.error(text_of(error));
    if (cohort::is_thread_limit(error)) return exit_failed;
  }
  return exit_usage;
}

}  // namespace

int main(int argc, char** argv) {
  cohort::open_standard_streams();
  cohort::outlive_readers();
  CommandLine line("Cohort: a deterministic simulator for groups of robots", "cohort");
  line.set_version(version_text, "Print the version and build information");
  line.set_help("Print this help and exit");
  line.require_subcommand();
  LogFlags flags;
  add_log_flags(line, flags);
  line.footer(
      "Example: cohort run obstacle_avoidance --duration 10\n"
      "'cohort COMMAND --help' describes a command; 'cohort help' describes the elements and keys of files.\n"
      "Exit codes: 0 success, 1 the run failed, 2 an error in the command line, in a file or in the set-up, 130 "
      "interrupted.");
  const std::vector<Subcommand> commands = add_commands(line, flags);

  LogOptions options;
  try {
    if (!line.parse(argc, argv)) {
      Log log(options);
      return code_after_output(exit_ok, log);
    }
    options = log_options(flags);
  } catch (const UsageError& error) {
    Log({.format = format_of_unreadable(argc, argv)}).error(error.what());
    return exit_usage;
  }
  Log log(options);
  log_dds_to(log);
  return code_after_output(run_chosen(commands, log, cohort::stop_on_signals()), log);
}
