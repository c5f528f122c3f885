#include "client_sdk/src/client.hpp"
#include "client_sdk/src/domains.hpp"
#include "client_sdk/src/plugin_loader.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {
int host(const HostCommand& command, Log& log, const std::atomic<bool>& stop) {
  try {
    const LoadedPlugin loaded(command.plugin, default_plugin_directories());
    ClientOptions options;
    options.server = command.server;
    if (!command.domains.empty()) options.domain = domain_of_this_process(command.domains);
    options.secure = command.secure;
    options.robots = command.robots;
    options.inline_step = command.inline_step;
    options.tell = [&](Severity severity, const std::string& text) {
      const std::string name = loaded.plugin().name;
      log.write(command.for_run ? LogLevel::debug : level_of(severity), name + ": " + text, {{"controller", name}});
    };
    switch (run_client(loaded.plugin(), options, stop)) {
      case ClientEnd::finished: return exit_ok;
      case ClientEnd::interrupted: return exit_interrupted;
      case ClientEnd::refused: return exit_usage;
      case ClientEnd::superseded: return command.for_run ? exit_superseded : exit_failed;
      case ClientEnd::failed:
      case ClientEnd::server_lost: return exit_failed;
    }
    return exit_failed;
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
}

}  // namespace cohort::tool
