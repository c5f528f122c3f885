// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/include/cohort/controller.hpp"

namespace cohort {

/// Returns the path of a plugin. `name_or_path` is a path to a shared object, or a name such as `obstacle_avoidance`,
/// searched as `NAME.so` in `directories` in order. Throws std::runtime_error that lists the searched paths.
std::filesystem::path find_plugin(const std::string& name_or_path,
                                  const std::vector<std::filesystem::path>& directories);

/// Returns true for the path of a controller, a plugin (`….so`) or a Python file (`….py`), and false for a name.
bool is_controller_path(const std::string& name_or_path);

/// Checks that a controller exists, and that its plugin can be loaded. For a Python file, this is the plugin `python`.
/// Does not run any of its code. Throws std::runtime_error with the reason.
void check_controller(const std::string& name_or_path, const std::vector<std::filesystem::path>& directories);

/// A controller plugin, loaded during the lifetime of this object. It must outlive all objects that the plugin has
/// created.
class LoadedPlugin {
 public:
  /// Finds the plugin as `find_plugin` does; for a path that ends with `.py`, the plugin `python`. Throws
  /// std::runtime_error if the plugin is not found, is not a controller plugin or was built for another version, or if
  /// the Python file has an error. Loads a file only if it is a plugin.
  LoadedPlugin(const std::string& name_or_path, const std::vector<std::filesystem::path>& directories);
  LoadedPlugin(LoadedPlugin&&) noexcept = default;
  LoadedPlugin& operator=(LoadedPlugin&&) noexcept = default;

  const Plugin& plugin() const { return *plugin_; }
  /// Returns the requested file: the plugin, or the Python file.
  const std::filesystem::path& path() const { return script_.empty() ? path_ : script_; }
  /// Returns the factory of the controllers of this file.
  const ControllerKind& kind() const { return kind_; }

 private:
  void read_script();

  std::filesystem::path path_;    // path of the plugin
  std::filesystem::path script_;  // path of the Python file, or empty
  std::unique_ptr<void, int (*)(void*)> library_;
  const Plugin* plugin_ = nullptr;
  ControllerKind kind_{};
};

/// Returns the search path of plugins: `COHORT_PLUGIN_PATH` (colon-separated), then, relative to the folder of the
/// running program, those of a build tree (`../lib/controllers`) and of an installation (`../lib/cohort/controllers`).
std::vector<std::filesystem::path> default_plugin_directories();

}  // namespace cohort
