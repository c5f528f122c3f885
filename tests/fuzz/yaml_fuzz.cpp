// SPDX-License-Identifier: Apache-2.0
#include "server/description/world.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/fuzz/fuzz_file.hpp"

/// Any file named .yaml is read, or refused with InputError.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const cohort::fuzz::FuzzFile file(".yaml");
  try {
    cohort::parsing::read_world_or_model(file.holding(data, size), 1);
  } catch (const cohort::description::InputError&) {
  }
  return 0;
}
