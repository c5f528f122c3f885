#pragma once

#include <cohort/control.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/cohort/commands/shared_options.hpp"

namespace cohort::tool {

/// What the command line says of `cohort ctl`: docs/cli.md.
struct CtlCommand {
  enum class What {
    request,
    status,
    history,
    save,
    load,
  };
  What what = What::request;
  std::function<std::string(Control&)> request{};  ///< asks, and returns what is printed
  Connection connection{};
  std::filesystem::path file{};     ///< of a snapshot
  std::optional<double> timeout{};  ///< [s]; none: by operation
  bool watch = false;
  bool json = false;
};

/// Throws std::runtime_error if the file cannot be read.
std::vector<char> read_file(const std::filesystem::path& file);

/// `command` must outlive the command line.
void add_ctl_options(CommandLine line, CtlCommand& command);

}  // namespace cohort::tool
