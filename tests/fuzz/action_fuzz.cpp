// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <vector>

#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/model_text.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace {

using namespace cohort;

description::Experiment small_experiment() {
  description::Experiment experiment;
  experiment.read_model = test::model_of_text;
  experiment.world = test::world_with_floor();
  const Eigen::Vector3d size = Eigen::Vector3d::Constant(0.2);
  test::place(experiment.world, test::loose("box", description::Box{size}, test::solid_box(2.0, size)), "box",
              test::at(-1, 0, 0.1));
  description::Model post = test::static_shape("post", description::Box{size});
  post.emitters.push_back({"lamp", 0, {}, true, description::Light{}});
  test::place(experiment.world, post, "post", test::at(1, 0, 0.1));
  return experiment;
}

// What was refused has changed nothing; what was done survives saving and restoring.
void act(const Action& action) {
  static const description::Experiment experiment = small_experiment();
  Simulation simulation(experiment, 1);
  const std::uint64_t before = simulation.state_hash();
  try {
    simulation.act(action);
  } catch (const std::invalid_argument&) {
    if (simulation.state_hash() != before) std::abort();
  }
  simulation.step();
  Simulation again(experiment, 1);
  again.restore(simulation.save());
  if (again.state_hash() != simulation.state_hash()) std::abort();
  simulation.step();
  again.step();
  if (again.state_hash() != simulation.state_hash()) std::abort();
}

}  // namespace

/// Any bytes are an action or refused with std::invalid_argument, and so is what they ask for.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  try {
    const Action action = action_from_bytes(bytes, test::model_of_text);
    // Older recordings write a spawn with another number.
    const std::vector<std::byte> again = to_bytes(action);
    if (again.size() != bytes.size() || !std::equal(again.begin() + 1, again.end(), bytes.begin() + 1)) std::abort();
    act(action);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
