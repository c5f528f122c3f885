#include "tools/cohort/commands/client_commands.hpp"

#include "tools/cohort/commands/command_lines.hpp"
#include "tools/cohort/commands/recording_options.hpp"

namespace cohort::tool {

void add_client_commands(CLI::App& app, ClientCommands& commands) {
  const std::string domain = "DDS domain of the server, the first if it has several (default: 0)";

  commands.ctl_app = app.add_subcommand("ctl", "Control a run: pause, step, change its world, save, ask how it is");
  add_domains(*commands.ctl_app, commands.ctl.domains, domain);
  add_secure_option(*commands.ctl_app, commands.ctl.secure,
                    "Folder of an identity that may control (default: $COHORT_SECURE)");
  add_ctl_commands(*commands.ctl_app, commands.ctl);

  commands.record_app = app.add_subcommand("record", "Record a run of a server from now on");
  add_live_record_options(*commands.record_app, commands.record.record);
  add_server_option(*commands.record_app, commands.record.server);
  add_domains(*commands.record_app, commands.record.domains, domain);
  add_secure_option(*commands.record_app, commands.record.secure,
                    "Folder of an identity that looks on or controls (default: $COHORT_SECURE)");

  commands.view_app = app.add_subcommand("view", "Show a recording or a running server in a browser");
  add_view_options(*commands.view_app, commands.view);
  add_domains(*commands.view_app, commands.view.domains, domain);
  add_secure_option(*commands.view_app, commands.view.secure,
                    "Folder of the observers' identity (default: $COHORT_SECURE)");
}

std::optional<int> ClientCommands::run(Log& log, const std::atomic<bool>& stop) const {
  if (ctl_app->parsed()) return tool::ctl(ctl, log, stop);
  if (record_app->parsed()) return tool::record(record, log, stop);
  if (view_app->parsed()) return tool::view(view, log, stop);
  return std::nullopt;
}

}  // namespace cohort::tool
