#include <iostream>

#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/installed_models.hpp"
#include "tools/cohort/team_controllers.hpp"

namespace cohort::tool {
namespace {

void print_world(const description::World& world) {
  std::cout << world.file.string() << ": " << world.instances.size() << " models, " << world.robots.size()
            << " robots, steps of " << std::chrono::duration<double, std::milli>(world.step).count() << " ms\n";
}

}  // namespace

int check(const std::filesystem::path& file) {
  try {
    if (file.extension() == ".sdf" || file.extension() == ".world") {
      description::Experiment experiment;
      experiment.file = file;
      experiment.world = description::read_world(file, experiment.seed, installed_model_folders());
      const Simulation built(experiment, 1);  // some mistakes only show when physics takes the world
      print_world(experiment.world);
    } else {
      const description::Experiment experiment = description::read_experiment(file, {}, {}, installed_model_folders());
      const Simulation built(experiment, 1);
      try_controllers(experiment, built, load_controllers(experiment));
      print_world(experiment.world);
      for (const description::Team& team : experiment.teams)
        std::cout << "team " << team.name << ": " << team.robots.size() << " robots, controller " << team.controller
                  << "\n";
    }
    std::cout << file.string() << ": no mistakes found\n";
    return exit_ok;
  } catch (const description::InputError& error) {
    std::cerr << error.what() << "\n";
  } catch (const std::exception& error) {
    std::cerr << file.string() << ": " << error.what() << "\n";
  }
  return exit_usage;
}

}  // namespace cohort::tool
