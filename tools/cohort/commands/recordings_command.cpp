#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "server/recording/recording.hpp"
#include "tools/cohort/cli/shown.hpp"
#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {
namespace {

void print_fact(const std::string& name, const std::string& value) { show(fmt::format("  {:<22} {}\n", name, value)); }

void list(const std::filesystem::path& file) {
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
  CommandLine line = app.add_subcommand("recordings", "What recordings are of, and which files they hold");
  line.require_subcommand();
  CommandLine of = line.add_subcommand("list", "Print the facts of each run, and the files that are attached");
  of.add_option("FILE", *files, "Recordings (.mcap)").required().type_name("");
  of.footer("Example: cohort recordings list run.mcap");
  line.footer("Example: cohort recordings list run.mcap");
  return {line, [files](Log&, const std::atomic<bool>&) {
            for (const std::filesystem::path& file : *files) list(file);
            return exit_ok;
          }};
}

}  // namespace cohort::tool
