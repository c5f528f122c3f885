// SPDX-License-Identifier: Apache-2.0
#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/cli/models/model_facts.hpp"

namespace cohort::tool {
namespace {

struct ShowCommand {
  std::filesystem::path file;
  double seconds = 0.0;  ///< simulated time before the output
  bool as_json = false;
  bool runs_xacro = false;
};

int show_model(const ShowCommand& command, Log& log, const std::atomic<bool>& stop) {
  const description::Experiment experiment = parsing::read_experiment(
      experiment_called(command.file), {}, {}, installed_model_folders(), xacro_of(command.runs_xacro));
  if (!command.as_json) log.warnings(experiment.world.warnings);
  Simulation simulation(experiment, 1);
  const std::chrono::nanoseconds end = nanoseconds(command.seconds);
  while (simulation.time() < end) {
    if (stop) return exit_interrupted;
    simulation.step();
  }
  show(command.as_json ? facts_as_json(simulation) : facts_as_text(simulation));
  return exit_ok;
}

}  // namespace

Subcommand add_models(CommandLine app) {
  const auto command = std::make_shared<ShowCommand>();
  CommandLine line = app.add_subcommand("models", "Show how Cohort has read a model");
  line.require_subcommand();
  CommandLine of = line.add_subcommand("show", "Print the links, masses, joints and limits of a model or a world");
  of.add_option("FILE", command->file, "Model (SDF, URDF or YAML), world or experiment: a file or an installed name")
      .required()
      .type_name("");
  of.add_flag("--json", command->as_json, "Print JSON, which also includes inertias, axes, poses and velocities");
  of.add_option("--after", command->seconds,
                "Simulate for this time first, in seconds; a single model is placed on a plane")
      .check(number_from_zero(most_seconds, "seconds"))
      .type_name("SECONDS");
  add_reading_options(of, command->runs_xacro);
  of.footer("Example: cohort models show sbot --json --after 5");
  line.footer("Example: cohort models show sbot");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return show_model(*command, log, stop); }};
}

}  // namespace cohort::tool
