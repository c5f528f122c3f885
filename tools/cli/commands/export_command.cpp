// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/named_world.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/output_file.hpp"

namespace cohort::tool {
namespace {

struct ExportCommand {
  std::filesystem::path file;
  std::filesystem::path output;         ///< .sdf or .yaml
  std::optional<std::uint64_t> seed{};  ///< seed of populations; none: the experiment's, or 1
  bool runs_xacro = false;
};

int export_world(const ExportCommand& command, Log& log) {
  const bool as_yaml = parsing::is_yaml(command.output);
  if (!as_yaml && command.output.extension() != ".sdf") {
    log.error("expected a file name that ends in .sdf or .yaml, not '" + command.output.extension().string() + "'");
    return exit_usage;
  }
  check_writable("the world", command.output);
  const description::World world = read_named_world(command.file, command.seed, xacro_of(command.runs_xacro));
  log.warnings(world.warnings);
  const parsing::XmlNode sdf = parsing::sdf_of(world, std::filesystem::absolute(command.output).parent_path());
  write_file("the world", command.output, as_yaml ? parsing::yaml_of_sdf(sdf) : parsing::xml_text(sdf));
  return exit_ok;
}

}  // namespace

Subcommand add_export(CommandLine app) {
  const auto command = std::make_shared<ExportCommand>();
  CommandLine line = app.add_subcommand("export", "Write a world, or the world of an experiment, as SDF or YAML");
  line.add_option("FILE", command->file, "World, model or experiment: a file or an installed name")
      .required()
      .type_name("");
  line.add_option("-o,--output", command->output, "File to write (.sdf or .yaml)").required().type_name("FILE");
  line.add_option("--seed", command->seed, "Seed for the placement of populations (default: the experiment's seed)")
      .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      .type_name("N");
  add_reading_options(line, command->runs_xacro);
  line.footer("Example: cohort export worlds/arenas/obstacles.sdf -o placed.sdf");
  return {line, [command](Log& log, const std::atomic<bool>&) { return export_world(*command, log); }};
}

}  // namespace cohort::tool
