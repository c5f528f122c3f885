#include "server/core/text.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/files/sample_file.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tools/cohort/cli/installed_models.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {
namespace {

// The model and the device that are meant: of the first robot of the file.
const description::Model& robot_of(const description::World& world, const SamplesCommand& command) {
  if (world.robots.empty())
    throw std::runtime_error("'" + command.file.string() + "' has no robot: a model with devices");
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

}  // namespace

int take_samples(const SamplesCommand& command, Log& log) {
  try {
    check_writable("samples", command.output);
    const description::World world = parsing::read_world_or_model(command.file, 1, installed_model_folders());
    const description::Model& model = robot_of(world, command);
    const description::Samples samples = sensing::take_samples(model, ring_of(model, command.device), command.grid);
    write_file("samples", command.output, parsing::samples_as_text(samples));
    return exit_ok;
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
