#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/description/write_world.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/installed_models.hpp"
#include "tools/cohort/output_file.hpp"

namespace cohort::tool {
namespace {

bool is_world(const std::filesystem::path& file) { return file.extension() == ".sdf" || file.extension() == ".world"; }

description::World read(const ExportCommand& command) {
  if (is_world(command.file)) return description::read_world(command.file, command.seed, installed_model_folders());
  const std::optional<std::uint64_t> seed = command.has_seed ? std::optional(command.seed) : std::nullopt;
  return description::read_experiment(command.file, seed, {}, installed_model_folders()).world;
}

}  // namespace

int export_world(const ExportCommand& command, Log& log) {
  try {
    if (!is_world(command.output)) {
      log.error("a world is written as .sdf, not as '" + command.output.extension().string() + "'");
      return exit_usage;
    }
    check_writable("the world", command.output);
    const description::World world = read(command);
    for (const description::Problem& warning : world.warnings) log.problem(LogLevel::warning, warning);
    write_file("the world", command.output,
               description::xml_text(description::sdf_of(world, command.output.parent_path())));
    return exit_ok;
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
