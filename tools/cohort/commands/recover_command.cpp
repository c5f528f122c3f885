#include <iostream>

#include "server/recording/mcap/disk_file.hpp"
#include "server/recording/mcap/recover.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/cli/output_file.hpp"

namespace cohort::tool {

int recover(const RecoverCommand& command, Log& log) {
  const std::filesystem::path& target = command.output.empty() ? command.file : command.output;
  try {
    const recording::FileBytes file(command.file);
    recording::check_magic(file);
    recording::check_not_being_written(command.file);
    check_writable("the recording", target);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  try {
    const recording::Recovery recovery = recording::recover(command.file, target);
    std::cout << target.string() << ": " << recovery.text();
    return exit_ok;
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_failed;
}

}  // namespace cohort::tool
