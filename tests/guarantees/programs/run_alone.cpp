// SPDX-License-Identifier: Apache-2.0

// run_alone EXPERIMENT PLUGIN: a program that embeds runs. It runs an experiment with one controller for all teams. It
// prints the state hash after the run, and after one more run with the next seed.

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/in_process.hpp"
#include "server/run/run_world.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  if (argc != 3) return 2;
  try {
    const LoadedPlugin plugin(argv[2], {});
    auto experiment = std::make_shared<const description::Experiment>(parsing::read_experiment(argv[1]));
    const std::vector<ControllerKind> controllers(experiment->teams.size(), kind_of(plugin.plugin()));
    const std::atomic<bool> stop{false};
    for (int run = 0; run < 2; ++run) {
      if (run > 0) experiment = session::with_seed(experiment, experiment->seed + 1);
      const session::RunWorld world = session::build_world(experiment, 1, nullptr);
      const session::RunResult result =
          session::run_in_process(*experiment, *world.simulation, controllers, {}, {}, stop);
      if (result.end != session::RunResult::End::finished) throw std::runtime_error(result.error);
      std::printf("%016llx\n", static_cast<unsigned long long>(result.state_hash));
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "run_alone: %s\n", error.what());
    return 1;
  }
}
