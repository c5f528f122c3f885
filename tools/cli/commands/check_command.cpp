// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/cli/models/robot_sheet.hpp"
#include "tools/cli/running/controller_ends.hpp"
#include "tools/cli/running/team_controllers.hpp"

namespace cohort::tool {
namespace {

void print_world(const description::World& world) {
  show(fmt::format("{}: {}, {}, steps of {:g} ms\n", world.file.string(), counted(world.instances.size(), "model"),
                   counted(world.robots.size(), "robot"),
                   std::chrono::duration<double, std::milli>(world.step).count()));
}

int check(const std::filesystem::path& named, parsing::Xacro xacro, const std::vector<std::string>& settings,
          bool loads_controllers, Log& log) {
  const std::filesystem::path file = experiment_called(named);
  try {
    if (parsing::kind_of_file(file) == parsing::FileKind::sdf && settings.empty()) {
      description::Experiment experiment;
      experiment.file = file;
      experiment.world = parsing::read_world_or_model(file, experiment.seed, installed_model_folders(), xacro);
      log.warnings(experiment.world.warnings);
      const Simulation built(experiment, 1);  // some errors appear only when the physics is built
      print_world(experiment.world);
      if (parsing::holds_lone_model(file)) show(robot_sheet(file, named.string(), xacro));
    } else {
      const description::Experiment experiment =
          parsing::read_experiment(file, {}, {}, installed_model_folders(), xacro, settings);
      log.warnings(experiment.world.warnings);
      const Simulation built(experiment, 1);
      if (loads_controllers) {
        const ControllerEnds ends(log, {.exit_code = exit_usage, .crashes = true});
        try_controllers(experiment, built, load_controllers(experiment));
      } else {
        check_controllers(experiment);
      }
      print_world(experiment.world);
      for (const description::Team& team : experiment.teams)
        show("team " + team.name + ": " + counted(team.robots.size(), "robot") + ", controller " + team.controller +
             "\n");
      if (!loads_controllers && !experiment.teams.empty())
        show("controllers were not loaded; '--load-controllers' also checks parameters and channels\n");
      if (const auto model = installed_model(named.string())) show(robot_sheet(*model, named.string(), xacro));
    }
    show(file.string() + ": no errors found\n");
    return exit_ok;
  } catch (const description::InputError&) {
    throw;
  } catch (const std::exception& error) {
    log.problem(LogLevel::error, {file, 0, "", error.what()});
  }
  return exit_usage;
}

}  // namespace

Subcommand add_check(CommandLine app) {
  struct CheckCommand {
    std::filesystem::path file{};
    bool loads_controllers = false;
    bool runs_xacro = false;
    std::vector<std::string> settings{};
  };
  const auto command = std::make_shared<CheckCommand>();
  CommandLine line =
      app.add_subcommand("check", "Check a world, a model or an experiment for errors without running it");
  line.add_option("FILE", command->file,
                  "Experiment (.yaml), world or model file, or the name of an example or a robot")
      .required()
      .type_name("");
  add_reading_options(line, command->runs_xacro);
  add_set_option(line, command->settings);
  line.add_flag("--load-controllers", command->loads_controllers,
                "Also load the controller plugins and start the controllers, which executes their code");
  line.footer("Example: cohort check worlds/arenas/obstacles.sdf");
  return {line, [command](Log& log, const std::atomic<bool>&) {
            return check(command->file, xacro_of(command->runs_xacro), command->settings, command->loads_controllers,
                         log);
          }};
}

}  // namespace cohort::tool
