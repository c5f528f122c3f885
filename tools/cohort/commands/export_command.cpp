#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/sdf/yaml_sdf.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tools/cohort/cli/installed_models.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {
namespace {

description::World read(const ExportCommand& command) {
  if (parsing::kind_of_file(command.file) == parsing::FileKind::sdf)
    return parsing::read_world_or_model(command.file, command.seed.value_or(1), installed_model_folders());
  return parsing::read_experiment(command.file, command.seed, {}, installed_model_folders()).world;
}

}  // namespace

int export_world(const ExportCommand& command, Log& log) {
  try {
    const bool as_yaml = parsing::is_yaml(command.output);
    if (!as_yaml && command.output.extension() != ".sdf") {
      log.error("a world is written as .sdf or .yaml, not as '" + command.output.extension().string() + "'");
      return exit_usage;
    }
    check_writable("the world", command.output);
    const description::World world = read(command);
    for (const description::Problem& warning : world.warnings) log.problem(LogLevel::warning, warning);
    const parsing::XmlNode sdf = parsing::sdf_of(world, command.output.parent_path());
    write_file("the world", command.output, as_yaml ? parsing::yaml_of_sdf(sdf) : parsing::xml_text(sdf));
    return exit_ok;
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
