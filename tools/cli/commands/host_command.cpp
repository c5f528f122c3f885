// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "client_sdk/src/attachment.hpp"
#include "idl/text/domains.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/running/controller_ends.hpp"

namespace cohort::tool {
namespace {

struct HostCommand {
  std::string plugin{};
  ClientSide client{};
  bool inline_step = false;  ///< ClientOptions
  bool for_run = false;      ///< started by `cohort run`, whose server reports the client's events
};

int host(const HostCommand& command, Log& log, const std::atomic<bool>& stop) {
  // Lines that a controller prints are seen at once, also by a pipe.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  const ControllerEnds ends(log, {.exit_code = exit_failed});
  const LoadedPlugin loaded(command.plugin, default_plugin_directories());
  const ControllerKind kind = loaded.kind();
  ClientOptions options;
  options.server = command.client.connection.server;
  if (!command.client.connection.domains.empty())
    options.domain = domain_of_this_process(command.client.connection.domains);
  options.secure = command.client.connection.secure;
  options.robots = command.client.robots;
  options.inline_step = command.inline_step;
  options.start_must_succeed = command.for_run;  // no other client would take its place
  options.tell = [&](Severity severity, const std::string& text) {
    log.write(command.for_run ? LogLevel::debug : level_of(severity), kind.name + ": " + text,
              {{"controller", kind.name}});
  };
  switch (run_client(kind, options, stop)) {
    case ClientEnd::finished: return exit_ok;
    case ClientEnd::interrupted: return exit_interrupted;
    case ClientEnd::refused: return exit_usage;
    case ClientEnd::superseded: return command.for_run ? exit_superseded : exit_failed;
    case ClientEnd::failed:
    case ClientEnd::server_lost: return exit_failed;
  }
  return exit_failed;
}

}  // namespace

Subcommand add_host(CommandLine app, LogFlags& flags) {
  const auto command = std::make_shared<HostCommand>();
  CommandLine line = app.add_subcommand("host", "Run a controller that drives robots of a server");
  line.add_option("PLUGIN", command->plugin, "Name of a controller, or path of its plugin or Python file")
      .required()
      .type_name("");
  add_client_options(line, command->client);
  add_log_flags(line, flags);
  line.add_flag("--inline", command->inline_step,
                "Step controllers on the receiving thread, which reduces latency; for steps shorter than 1 ms");
  line.add_flag("--for-run", command->for_run).hide();  // for `cohort run` only
  line.footer("Example: cohort host obstacle_avoidance --robots 0..7 --server 10.0.0.5 --domain 7");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return host(*command, log, stop); }};
}

}  // namespace cohort::tool
