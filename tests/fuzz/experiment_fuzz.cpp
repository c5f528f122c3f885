// SPDX-License-Identifier: Apache-2.0
#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/fuzz/fuzz_file.hpp"

/// Any experiment, beside a world `arena.yml`, is read, or refused with InputError.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const cohort::fuzz::FuzzFile file(".yaml");
  static const bool has_world = [] {
    file.add("arena.yml",
             "world:\n  model:\n    - name: m\n      link: {name: l, inertial: {mass: 1, inertia: {ixx: 1}}}\n"
             "      joint: {name: j, type: revolute, parent: world, child: l, axis: {xyz: [0, 0, 1]}}\n"
             "      cohort:velocity_motor: {name: v, joint: j, max_velocity: 1, max_effort: 1}\n");
    return true;
  }();
  try {
    if (has_world) cohort::parsing::read_experiment(file.holding(data, size));
  } catch (const cohort::description::InputError&) {
  }
  return 0;
}
