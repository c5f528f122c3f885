// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "server/core/text.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

// Returns the first sentence of the comment at the beginning of the file.
std::string first_sentence(const fs::path& file) {
  std::ifstream stream(file);
  std::string text;
  for (std::string line; std::getline(stream, line) && line.starts_with('#');)
    text += std::string(trimmed(line.substr(1))) + " ";
  text.resize(std::min(text.find(". "), text.size()));
  constexpr std::size_t width = 95;
  if (text.size() <= width) return text;
  return text.substr(0, text.rfind(' ', width)) + " …";
}

int list() {
  for (const std::string& name : installed_experiments()) {
    const fs::path file = installed_worlds_folder() / "experiments" / (name + ".yaml");
    show(fmt::format("{:<24} {}\n", name, first_sentence(file)));
  }
  show("\n'cohort run NAME' runs one; 'cohort examples --copy DIR' copies all, with their arenas and robots.\n");
  return exit_ok;
}

int copy_to(const fs::path& folder) {
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw std::invalid_argument("'" + folder.string() +
                                "' exists and is not an empty folder: choose a new or empty folder");
  fs::create_directories(folder);
  fs::copy(installed_worlds_folder(), folder, fs::copy_options::recursive);
  show("cohort run " + (folder / "experiments/obstacle_avoidance.yaml").string() + "\n");
  return exit_ok;
}

}  // namespace

Subcommand add_examples(CommandLine app) {
  const auto folder = std::make_shared<fs::path>();
  CommandLine line = app.add_subcommand("examples", "List the experiments that come with Cohort, or copy them");
  line.add_option("--copy", *folder, "Copy the examples and all files that they need to this folder").type_name("DIR");
  line.footer("Example: cohort examples --copy worlds");
  return {line, [folder](Log&, const std::atomic<bool>&) { return folder->empty() ? list() : copy_to(*folder); }};
}

}  // namespace cohort::tool
