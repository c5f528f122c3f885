#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "client_sdk/include/cohort/controller.hpp"

namespace cohort {

/// Returns the path of a plugin. `name_or_path`: a path to a shared object, or a name such as `obstacle_avoidance`,
/// looked for as `NAME.so` in `directories` in order. Throws std::runtime_error that says what was tried.
std::filesystem::path find_plugin(const std::string& name_or_path,
                                  const std::vector<std::filesystem::path>& directories);

/// A controller plugin, loaded as long as this lives. Objects that it made must be gone before.
class LoadedPlugin {
 public:
  /// Finds the plugin as `find_plugin` does. Throws std::runtime_error that says what is wrong with it (not found, not
  /// a controller plugin, built for another version). Only a file that is a plugin is loaded.
  LoadedPlugin(const std::string& name_or_path, const std::vector<std::filesystem::path>& directories);
  LoadedPlugin(LoadedPlugin&&) noexcept = default;
  LoadedPlugin& operator=(LoadedPlugin&&) noexcept = default;

  const Plugin& plugin() const { return *plugin_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<void, int (*)(void*)> library_;
  const Plugin* plugin_ = nullptr;
};

/// Where plugins are looked for: `COHORT_PLUGIN_PATH` (colon-separated), then, from the folder of the running program,
/// those of a build tree (`../lib/controllers`) and of an installation (`../lib/cohort/controllers`).
std::vector<std::filesystem::path> default_plugin_directories();

}  // namespace cohort
