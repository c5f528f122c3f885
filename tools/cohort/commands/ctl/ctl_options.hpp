#pragma once

#include <filesystem>
#include <optional>

#include "idl/wire/control_messages.hpp"
#include "tools/cohort/commands/shared_options.hpp"

namespace cohort::tool {

/// What the command line says of `cohort ctl`: docs/cli.md.
struct CtlCommand {
  enum class What {
    request,  ///< `operation`, and its reply
    status,
    history,
    save,
    load,
  };
  What what = What::request;
  wire::Operation operation{};  ///< of a request
  Connection connection{};
  std::filesystem::path file{};     ///< of a snapshot
  std::filesystem::path model{};    ///< of what is spawned: a file, or the name of a model of the world
  std::optional<double> timeout{};  ///< [s]; none: by operation
  bool watch = false;
  bool json = false;
};

/// `command` must outlive the command line.
void add_ctl_options(CommandLine line, CtlCommand& command);

}  // namespace cohort::tool
