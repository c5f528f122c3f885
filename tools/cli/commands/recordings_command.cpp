// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "server/recording/recording.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/running/run_recording.hpp"

namespace cohort::tool {
namespace {

void print_fact(const std::string& name, const std::string& value) { show(fmt::format("  {:<22} {}\n", name, value)); }

void list(const std::filesystem::path& file) {
  refuse_experiment(file);
  const recording::Recording recording(file);
  show(file.string() + "\n");
  for (const auto& [name, value] : recording.facts()) print_fact(name, value);
  print_fact("end", recording.end().empty() ? "not known" : recording.end());
  if (!recording.damage().empty()) print_fact("damage", recording.damage());
  for (const recording::AttachmentIndex& attachment : recording.reader().attachments())
    print_fact("attached", std::to_string(attachment.data_size) + " bytes, " + attachment.name);
}

}  // namespace

Subcommand add_recordings(CommandLine app) {
  const auto files = std::make_shared<std::vector<std::filesystem::path>>();
  CommandLine line =
      app.add_subcommand("recordings", "Show the contents of recordings, or make them readable as rosbag2 bags");
  line.require_subcommand();
  CommandLine of = line.add_subcommand("list", "Print the metadata and the attached files of each recording");
  of.add_option("FILE", *files, "Recordings (.mcap)").required().type_name("");
  of.footer("Example: cohort recordings list run.mcap");
  CommandLine bag = line.add_subcommand(
      "rosbag2", "Write metadata.yaml beside each recording, so that 'ros2 bag' can read its folder as a bag");
  bag.add_option("FILE", *files, "Recordings (.mcap), each in its own folder").required().type_name("");
  bag.footer("Example: cohort recordings rosbag2 house/run.mcap");
  line.footer("Example: cohort recordings list run.mcap");
  return {line, [files, bag](Log&, const std::atomic<bool>&) {
            for (const std::filesystem::path& file : *files) bag.parsed() ? write_rosbag2_metadata(file) : list(file);
            return exit_ok;
          }};
}

}  // namespace cohort::tool
