// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/recover.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

struct RecoverCommand {
  std::filesystem::path file;
  std::filesystem::path output;  ///< empty: replace `file`
};

int recover(const RecoverCommand& command, Log& log) {
  const std::filesystem::path& target = command.output.empty() ? command.file : command.output;
  const recording::FileBytes file(command.file);
  recording::check_magic(file);
  recording::check_not_being_written(command.file);
  check_writable("the recording", target);
  try {
    const recording::Recovery recovery = recording::recover(command.file, target);
    show(target.string() + ": " + recovery.text());
    return exit_ok;
  } catch (const recording::McapError& error) {
    log.error(text_of(error));
    return exit_usage;
  } catch (const std::exception& error) {
    log.error(text_of(error));
  }
  return exit_failed;
}

}  // namespace

Subcommand add_recover(CommandLine app) {
  const auto command = std::make_shared<RecoverCommand>();
  CommandLine line = app.add_subcommand("recover", "Repair a damaged recording: keep its readable part");
  line.add_option("FILE", command->file, "Recording (.mcap)").required().type_name("");
  line.add_option("-o,--output", command->output, "File to write (default: replace FILE)").type_name("FILE");
  line.footer("Example: cohort recover run.mcap");
  return {line, [command](Log& log, const std::atomic<bool>&) { return recover(*command, log); }};
}

}  // namespace cohort::tool
