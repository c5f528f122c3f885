#include "tools/cohort/controller_plugins.hpp"

namespace cohort::tool {

std::vector<LoadedPlugin> load_controllers(const description::Experiment& experiment) {
  std::vector<LoadedPlugin> plugins;
  for (const description::Team& team : experiment.teams) {
    std::string name = team.controller;
    const bool is_path = name.find('/') != std::string::npos;
    if (is_path && std::filesystem::path(name).is_relative()) name = experiment.file.parent_path() / name;
    try {
      plugins.emplace_back(name, default_plugin_directories());
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("team '" + team.name + "': " + error.what());
    }
  }
  return plugins;
}

}  // namespace cohort::tool
