#include <iostream>

#include "client_sdk/src/client.hpp"
#include "client_sdk/src/plugin_loader.hpp"
#include "tools/cohort/commands.hpp"

namespace cohort::tool {

int host(const HostCommand& command, const std::atomic<bool>& stop) {
  try {
    const LoadedPlugin loaded(command.plugin, default_plugin_directories());
    ClientOptions options;
    options.server = command.server;
    options.domain = command.domain;
    options.robots = command.robots;
    switch (run_client(loaded.plugin(), options, stop)) {
      case ClientEnd::finished: return exit_ok;
      case ClientEnd::interrupted: return exit_interrupted;
      case ClientEnd::refused: return exit_usage;
      case ClientEnd::superseded:
      case ClientEnd::failed:
      case ClientEnd::server_lost: return exit_failed;
    }
    return exit_failed;
  } catch (const std::exception& error) {
    std::cerr << "cohort host: " << error.what() << "\n";
    return exit_usage;
  }
}

}  // namespace cohort::tool
