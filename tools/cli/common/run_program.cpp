// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/run_program.hpp"

#include <cstdlib>
#include <new>
#include <string>
#include <string_view>

#include "client_sdk/include/cohort/client.hpp"
#include "idl/dds/transport.hpp"
#include "server/core/atomic_file.hpp"
#include "server/core/thread_room.hpp"
#include "server/description/input_error.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/output_file.hpp"

namespace cohort::tool {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one log for the process.
Log* dds_log = nullptr;

void log_dds_to(Log& log) {
  dds_log = &log;
  wire::set_dds_log([](std::string_view message, wire::DdsLogKind kind) noexcept {
    using wire::DdsLogKind;
    if (kind == DdsLogKind::refusal) return dds_log->warning(std::string(message));
    if (kind != DdsLogKind::fatal) return dds_log->debug("dds: " + std::string(message));
    // Cyclone ends the process after this message.
    if (message.find("ddsrt_thread_create failed") != std::string_view::npos) {
      dds_log->error(ThreadLimit("a thread of DDS").what());
      std::_Exit(exit_failed);
    }
    dds_log->error("dds: " + std::string(message));
  });
}

// Runs the command and logs its exceptions. Returns the exit code.
int run_and_log(const CommandFunction& run, Log& log, const std::atomic<bool>& stop) {
  try {
    return run(log, stop);
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const WriteError& error) {
    log.error(error.what());
    return exit_failed;
  } catch (const std::bad_alloc& error) {
    log.error(text_of(error));
    return exit_failed;
  } catch (const std::exception& error) {
    log.error(text_of(error));
    if (is_thread_limit(error)) return exit_failed;
  }
  return exit_usage;
}

}  // namespace

int run_program(CommandLine line, const LogFlags& flags, int argc, const char* const* argv,
                const CommandFunction& run) {
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
  return code_after_output(run_and_log(run, log, stop_on_signals()), log);
}

}  // namespace cohort::tool
