#include "tools/cohort/controller_plugins.hpp"

#include "server/description/input_error.hpp"

namespace cohort::tool {

std::vector<LoadedPlugin> load_controllers(const description::Experiment& experiment) {
  std::vector<LoadedPlugin> plugins;
  std::vector<description::Problem> problems;
  for (std::size_t i = 0; i < experiment.teams.size(); ++i) {
    const description::Team& team = experiment.teams[i];
    std::string name = team.controller;
    const bool is_path = name.find('/') != std::string::npos;
    if (is_path && std::filesystem::path(name).is_relative()) name = experiment.file.parent_path() / name;
    try {
      plugins.emplace_back(name, default_plugin_directories());
    } catch (const std::runtime_error& error) {
      const std::string element = "teams[" + std::to_string(i) + "].controller";
      problems.push_back({experiment.file, team.controller_line, element, error.what()});
    }
  }
  if (!problems.empty()) throw description::InputError(std::move(problems));
  return plugins;
}

}  // namespace cohort::tool
