// SPDX-License-Identifier: Apache-2.0

// Steps the world of an experiment, with commands that are a function of robot and tick:
// `step_world EXPERIMENT FROM TO [--load FILE] [--save FILE] [--threads N] [--act TICK]`.
// FROM is the tick of the world after construction or loading. At the tick of --act, objects are spawned, moved,
// pushed and removed. Prints the state hash at TO.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/guarantees/programs/command_by_sines.hpp"

namespace {

void act(cohort::Simulation& simulation) {
  const std::string crate =
      "<sdf version='1.9'><model name='crate'><link name='body'><inertial><mass>1</mass><inertia><ixx>0.01</ixx>"
      "<iyy>0.01</iyy><izz>0.01</izz></inertia></inertial><collision name='hull'><geometry><box><size>0.2 0.2 0.2"
      "</size></box></geometry></collision></link></model></sdf>";
  const std::string near = simulation.robot_name(0), other = simulation.robot_name(1);
  cohort::Pose above = simulation.robot_pose(0);
  above.position.z() += 0.4;
  const std::vector<cohort::Action> actions = {
      cohort::SpawnObject{"crate", simulation.experiment().read_model(crate), above},
      cohort::ApplyForce{"crate", "", {2, 0, 0}, {0, 0, 0.1}, std::chrono::seconds(2)},
      cohort::SetVelocity{near, {0.1, 0, 0}, {0, 0, 1}}, cohort::RemoveObject{other}};
  for (const cohort::ActionResult& result : simulation.act(actions))
    if (!result.is_done) throw std::runtime_error(result.text);
}

std::vector<std::byte> read(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

}  // namespace

int main(int count, char** arguments) {
  std::map<std::string, std::string> options;
  for (int i = 4; i + 1 < count; i += 2) options[arguments[i]] = arguments[i + 1];
  const auto experiment = cohort::parsing::read_experiment(arguments[1]);
  const unsigned threads = options.contains("--threads") ? static_cast<unsigned>(std::stoul(options["--threads"])) : 1;
  cohort::Simulation simulation(experiment, threads);
  if (options.contains("--load")) simulation.restore(read(options["--load"]));
  if (simulation.tick() != std::stoull(arguments[2])) return EXIT_FAILURE;
  const std::uint64_t acting = options.contains("--act") ? std::stoull(options["--act"]) : ~std::uint64_t{0};
  while (simulation.tick() < std::stoull(arguments[3])) {
    if (simulation.tick() == acting) act(simulation);
    cohort::test::command_by_sines(simulation);
    simulation.step();
  }
  if (options.contains("--save")) {
    const std::vector<std::byte> snapshot = simulation.save();
    std::ofstream(options["--save"], std::ios::binary)
        .write(reinterpret_cast<const char*>(snapshot.data()), static_cast<std::streamsize>(snapshot.size()));
  }
  std::printf("%016lx\n", static_cast<unsigned long>(simulation.state_hash()));
}
