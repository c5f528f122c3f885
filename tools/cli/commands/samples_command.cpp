// SPDX-License-Identifier: Apache-2.0
#include "server/core/text.hpp"
#include "server/parsing/files/sample_file.hpp"
#include "server/sensing/readings/take_samples.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/named_world.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/output_file.hpp"

namespace cohort::tool {
namespace {

struct SamplesCommand {
  std::filesystem::path file;  ///< model, or a world or an experiment, whose first robot is used
  std::string device{};        ///< name of a proximity ring
  std::filesystem::path output;
  sensing::SampleGrid grid{};
  bool runs_xacro = false;
};

// Returns the model of the file's first robot, and checks that it has the device.
const description::Model& robot_of(const description::World& world, const SamplesCommand& command) {
  if (world.robots.empty())
    throw std::runtime_error("'" + command.file.string() + "' has no robot (a model with devices)");
  return world.robot_model(0);
}

std::size_t ring_of(const description::Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    if (!std::holds_alternative<description::ProximityRing>(model.devices[device])) continue;
    names.push_back(description::name_of(model.devices[device]));
    if (names.back() == name) return device;
  }
  throw std::runtime_error("the model '" + model.name + "' has no proximity_ring '" + name + "'" +
                           suggestion(name, names));
}

int take_samples(const SamplesCommand& command) {
  check_writable("samples", command.output);
  const description::World world = read_named_world(command.file, {}, xacro_of(command.runs_xacro));
  const description::Model& model = robot_of(world, command);
  const description::Samples samples = sensing::take_samples(model, ring_of(model, command.device), command.grid);
  write_file("samples", command.output, parsing::samples_as_text(samples));
  return exit_ok;
}

}  // namespace

Subcommand add_samples(CommandLine app) {
  const auto command = std::make_shared<SamplesCommand>();
  CommandLine line = app.add_subcommand(
      "samples", "Compute a sample file: the readings of a ring of proximity sensors near a cylinder");
  constexpr double longest = 1e3;  // [m]
  line.add_option("MODEL", command->file,
                  "Model, or a world or experiment, whose first robot is used: a file or an installed name")
      .required()
      .type_name("");
  line.add_option("DEVICE", command->device, "Name of a proximity_ring of the robot").required().type_name("");
  line.add_option("-o,--output", command->output, "Sample file to write").required().type_name("FILE");
  line.add_option("--radius", command->grid.radius, "Radius of the cylinder [m]")
      .check(number_above_zero(longest, "metres"))
      .capture_default_str()
      .type_name("M");
  line.add_option("--height", command->grid.height, "Height of the cylinder [m]")
      .check(number_above_zero(longest, "metres"))
      .capture_default_str()
      .type_name("M");
  line.add_option("--distances", command->grid.distances, "Number of distances, from contact to the end of the range")
      .check(whole_number(2, 10'000))
      .capture_default_str()
      .type_name("N");
  line.add_option("--angles", command->grid.angles, "Number of angles, evenly spaced around the robot")
      .check(whole_number(1, 10'000))
      .capture_default_str()
      .type_name("N");
  add_reading_options(line, command->runs_xacro);
  line.footer("Example: cohort samples sbot proximity -o proximity.csv");
  return {line, [command](Log&, const std::atomic<bool>&) { return take_samples(*command); }};
}

}  // namespace cohort::tool
