// SPDX-License-Identifier: Apache-2.0

// Steps a batch of an experiment's worlds, world i with the seed i, all commands being neutral.
//   step_batch EXPERIMENT WORLDS TICKS THREADS
// Prints the state hash of each world.

#include <cstdio>
#include <string>

#include "server/batch/batch.hpp"
#include "server/parsing/experiment/read_experiment.hpp"

int main(int, char** arguments) {
  const std::size_t worlds = std::stoul(arguments[2]);
  cohort::Batch batch(cohort::parsing::read_experiment(arguments[1]), worlds,
                      static_cast<unsigned>(std::stoul(arguments[4])));
  for (std::size_t world = 0; world < worlds; ++world) batch.reset(world, world);
  batch.step(std::stoull(arguments[3]));
  for (std::size_t world = 0; world < worlds; ++world)
    std::printf("%016lx\n", static_cast<unsigned long>(batch.hash(world)));
}
