#include "tools/cohort/cli/installed_files.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "server/core/text.hpp"

namespace cohort::tool {
namespace {

std::filesystem::path installed(const char* folder) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  return (program.parent_path() / COHORT_DATA_FROM_BIN / "cohort" / folder).lexically_normal();
}

}  // namespace

std::vector<std::filesystem::path> installed_model_folders() {
  const std::filesystem::path worlds = installed("worlds");
  if (worlds.empty()) return {};
  return {worlds / "robots", worlds / "objects"};
}

std::filesystem::path installed_worlds_folder() { return installed("worlds"); }

std::vector<std::string> installed_experiments() {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(installed_worlds_folder() / "experiments", none))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

std::filesystem::path experiment_called(const std::filesystem::path& name) {
  std::error_code none;
  if (name.has_parent_path() || name.has_extension() || std::filesystem::exists(name, none)) return name;
  const std::vector<std::string> known = installed_experiments();
  if (std::ranges::count(known, name.string()) > 0)
    return installed_worlds_folder() / "experiments" / (name.string() + ".yaml");
  throw std::invalid_argument("there is neither a file '" + name.string() + "' nor an example of this name" +
                              suggestion(name.string(), known) + " ('cohort examples' lists them)");
}

std::filesystem::path model_called(const std::filesystem::path& name) {
  std::error_code none;
  if (name.has_parent_path() || name.has_extension() || std::filesystem::exists(name, none)) return name;
  std::vector<std::string> known;
  for (const std::filesystem::path& folder : installed_model_folders())
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::filesystem::path file = entry.path() / "model.sdf";
      if (!std::filesystem::exists(file, none)) continue;
      if (entry.path().filename() == name) return file;
      known.push_back(entry.path().filename());
    }
  throw std::invalid_argument("there is neither a file '" + name.string() + "' nor a model of this name" +
                              suggestion(name.string(), known));
}

std::filesystem::path installed_page_folder() { return installed("view"); }

}  // namespace cohort::tool
