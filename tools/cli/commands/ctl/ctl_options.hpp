// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/control.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/commands/shared_options.hpp"

namespace cohort::tool {

/// The command line of `cohort ctl`; see docs/cli.md.
struct CtlCommand {
  enum class What {
    request,
    status,
    history,
    save,
    load,
  };
  What what = What::request;
  std::function<std::string(Control&)> request{};  ///< executes the request, and returns the text to print
  Connection connection{};
  std::filesystem::path file{};     ///< snapshot file
  std::optional<double> timeout{};  ///< [s]; none: by operation
  bool watch = false;
  bool json = false;
};

/// Adds the options and subcommands. `command` must outlive the command line.
void add_ctl_options(CommandLine line, CtlCommand& command);

}  // namespace cohort::tool
