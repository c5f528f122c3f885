#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {

/// What the command line says of the commands that control or watch a run of a server.
struct ClientCommands {
  CtlCommand ctl;
  RecordCommand record;
  ViewCommand view;
  CLI::App* ctl_app = nullptr;
  CLI::App* record_app = nullptr;
  CLI::App* view_app = nullptr;

  std::vector<CLI::App*> apps() const { return {ctl_app, record_app, view_app}; }
  /// Runs the one that was asked for; nothing if none was. The exit code.
  std::optional<int> run(Log& log, const std::atomic<bool>& stop) const;
};

/// Adds them to `app`. `commands` must outlive it.
void add_client_commands(CLI::App& app, ClientCommands& commands);

}  // namespace cohort::tool
