// Steps the world of an experiment, with commands that are a function of robot and tick.
//   step_world EXPERIMENT FROM TO [--load FILE] [--save FILE] [--threads N]
// FROM: the tick at which the world stands after construction or loading. Prints the state hash at TO.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "server/simulation/simulation.hpp"

namespace {

void command(cohort::Simulation& simulation) {
  std::vector<double> values;
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    values.clear();
    const double phase = 0.013 * static_cast<double>(simulation.tick()) + robot;
    for (const cohort::Channel& channel : simulation.kinds()[simulation.kind_of(robot)].command)
      for (std::uint32_t i = 0; i < channel.size; ++i)
        values.push_back(0.5 * channel.upper * std::sin(phase + static_cast<double>(values.size())));
    simulation.set_command(robot, values);
  }
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
  const auto experiment = cohort::description::read_experiment(arguments[1]);
  const unsigned threads = options.contains("--threads") ? static_cast<unsigned>(std::stoul(options["--threads"])) : 1;
  cohort::Simulation simulation(experiment, threads);
  if (options.contains("--load")) simulation.restore(read(options["--load"]));
  if (simulation.tick() != std::stoull(arguments[2])) return EXIT_FAILURE;
  while (simulation.tick() < std::stoull(arguments[3])) {
    command(simulation);
    simulation.step();
  }
  if (options.contains("--save")) {
    const std::vector<std::byte> snapshot = simulation.save();
    std::ofstream(options["--save"], std::ios::binary)
        .write(reinterpret_cast<const char*>(snapshot.data()), static_cast<std::streamsize>(snapshot.size()));
  }
  std::printf("%016lx\n", static_cast<unsigned long>(simulation.state_hash()));
}
