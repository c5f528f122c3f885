// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/installed_files.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <ranges>
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

using Models = std::map<std::string, std::filesystem::path>;  // files by name

Models models_in(const std::filesystem::path& folder) {
  Models models;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::filesystem::path file = entry.path() / "model.sdf";
    if (std::filesystem::exists(file, none)) models.emplace(entry.path().filename(), file);
  }
  return models;
}

Models installed_model_files() {
  Models models;
  for (const std::filesystem::path& folder : installed_model_folders()) models.merge(models_in(folder));
  return models;
}

std::vector<std::string> names_of(const Models& models) {
  const auto names = std::views::keys(models);
  return {names.begin(), names.end()};
}

// Returns true if the text cannot be the name of something that comes with Cohort.
bool is_path(const std::filesystem::path& name) {
  std::error_code none;
  return name.has_parent_path() || name.has_extension() || std::filesystem::exists(name, none);
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

std::vector<std::string> installed_robots() { return names_of(models_in(installed_worlds_folder() / "robots")); }

std::vector<std::string> installed_models() { return names_of(installed_model_files()); }

std::optional<std::filesystem::path> installed_model(const std::string& name) {
  const Models models = installed_model_files();
  const auto model = models.find(name);
  return model == models.end() ? std::nullopt : std::optional(model->second);
}

std::filesystem::path experiment_called(const std::filesystem::path& name) {
  if (is_path(name)) return name;
  std::vector<std::string> known = installed_experiments();
  if (std::ranges::count(known, name.string()) > 0)
    return installed_worlds_folder() / "experiments" / (name.string() + ".yaml");
  if (const auto model = installed_model(name)) return *model;
  std::ranges::copy(names_of(installed_model_files()), std::back_inserter(known));
  throw std::invalid_argument("there is no file, example or model named '" + name.string() + "'" +
                              suggestion(name.string(), known) + " ('cohort examples' lists examples)");
}

std::filesystem::path model_called(const std::filesystem::path& name) {
  if (is_path(name)) return name;
  if (const auto model = installed_model(name)) return *model;
  throw std::invalid_argument("there is no file or model named '" + name.string() + "'" +
                              suggestion(name.string(), names_of(installed_model_files())));
}

std::filesystem::path installed_page_folder() { return installed("view"); }

}  // namespace cohort::tool
