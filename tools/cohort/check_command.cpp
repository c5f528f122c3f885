#include <iostream>

#include "server/description/experiment.hpp"
#include "server/description/file_kind.hpp"
#include "server/description/input_error.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/installed_models.hpp"
#include "tools/cohort/team_controllers.hpp"
#include "tools/cohort/wording.hpp"

namespace cohort::tool {
namespace {

void print_world(const description::World& world) {
  std::cout << world.file.string() << ": " << counted(world.instances.size(), "model") << ", "
            << counted(world.robots.size(), "robot") << ", steps of "
            << std::chrono::duration<double, std::milli>(world.step).count() << " ms\n";
}

void warn(const description::World& world, Log& log) {
  for (const description::Problem& warning : world.warnings) log.problem(LogLevel::warning, warning);
}

}  // namespace

int check(const std::filesystem::path& file, Log& log) {
  try {
    if (description::kind_of_file(file) == description::FileKind::sdf) {
      description::Experiment experiment;
      experiment.file = file;
      experiment.world = description::read_world_or_model(file, experiment.seed, installed_model_folders());
      warn(experiment.world, log);
      const Simulation built(experiment, 1);  // some mistakes only show when physics takes the world
      print_world(experiment.world);
    } else {
      const description::Experiment experiment = description::read_experiment(file, {}, {}, installed_model_folders());
      warn(experiment.world, log);
      const Simulation built(experiment, 1);
      try_controllers(experiment, built, load_controllers(experiment));
      print_world(experiment.world);
      for (const description::Team& team : experiment.teams)
        std::cout << "team " << team.name << ": " << counted(team.robots.size(), "robot") << ", controller "
                  << team.controller << "\n";
    }
    std::cout << file.string() << ": no mistakes found\n";
    return exit_ok;
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.problem(LogLevel::error, {file, 0, "", error.what()});
  }
  return exit_usage;
}

}  // namespace cohort::tool
