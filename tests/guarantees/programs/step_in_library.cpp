// SPDX-License-Identifier: Apache-2.0

// The same as step_world, as a shared library for load_library.c.

#include <cstdint>
#include <cstdio>
#include <exception>

#include "client_sdk/math/library_calls.hpp"
#include "client_sdk/math/portable_math.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/guarantees/programs/command_by_sines.hpp"

// Returns 0, and the state hash after these ticks. `binds`: whether calls of libraries are bound to our functions.
extern "C" __attribute__((visibility("default"))) int step_in_library(const char* experiment, std::uint64_t ticks,
                                                                      int binds, std::uint64_t* hash) {
  try {
    if (binds != 0) cohort::bind_library_calls();
    if (cohort::functions_not_portable().empty() != (binds != 0)) {
      std::fprintf(stderr, "calls of libraries are bound: %d, expected %d\n", binds == 0, binds != 0);
      return 1;
    }
    cohort::Simulation simulation(cohort::parsing::read_experiment(experiment), 1);
    while (simulation.tick() < ticks) {
      cohort::test::command_by_sines(simulation);
      simulation.step();
    }
    *hash = simulation.state_hash();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
