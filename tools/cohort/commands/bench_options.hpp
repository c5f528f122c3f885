#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {

/// What the command line says of `cohort bench` and its subcommands.
struct BenchOptions {
  BenchCommand scenes;
  bench::ThesisOptions thesis;
  bench::LockstepOptions lockstep;
  std::vector<std::string> placements;
  bench::BenchClient client;
  CLI::App* thesis_app = nullptr;
  CLI::App* lockstep_app = nullptr;
  CLI::App* client_app = nullptr;

  /// What was asked for, once it is parsed.
  BenchCommand command() const;
};

/// Adds the command to `app`. `options` must outlive it.
CLI::App* add_bench(CLI::App& app, BenchOptions& options);

}  // namespace cohort::tool
