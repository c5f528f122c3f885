#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/include/cohort/controller.hpp"

namespace cohort {

/// Returns the path of a plugin. `name_or_path`: a path to a shared object, or a name such as `obstacle_avoidance`,
/// looked for as `NAME.so` in `directories` in order. Throws std::runtime_error that says what was tried.
std::filesystem::path find_plugin(const std::string& name_or_path,
                                  const std::vector<std::filesystem::path>& directories);

/// Returns whether this is a path of a controller, a plugin (`….so`) or a file of Python (`….py`), and not a name.
bool is_controller_path(const std::string& name_or_path);

/// Checks, without running any of its code, that a controller is there, and that its plugin can be loaded: that of a
/// file of Python is the plugin `python`. Throws std::runtime_error that says what is wrong.
void check_controller(const std::string& name_or_path, const std::vector<std::filesystem::path>& directories);

/// A controller plugin, loaded as long as this lives. Objects that it made must be gone before.
class LoadedPlugin {
 public:
  /// Finds the plugin as `find_plugin` does; for a path that ends with `.py`, the plugin `python`. Throws
  /// std::runtime_error that says what is wrong with it (not found, not a controller plugin, built for another
  /// version), or with the file of Python. Only a file that is a plugin is loaded.
  LoadedPlugin(const std::string& name_or_path, const std::vector<std::filesystem::path>& directories);
  LoadedPlugin(LoadedPlugin&&) noexcept = default;
  LoadedPlugin& operator=(LoadedPlugin&&) noexcept = default;

  const Plugin& plugin() const { return *plugin_; }
  /// The file that was asked for: the plugin, or the file of Python.
  const std::filesystem::path& path() const { return script_.empty() ? path_ : script_; }
  /// Returns how to make the controllers of this file.
  const ControllerKind& kind() const { return kind_; }

 private:
  void read_script();

  std::filesystem::path path_;    // of the plugin
  std::filesystem::path script_;  // of Python, or empty
  std::unique_ptr<void, int (*)(void*)> library_;
  const Plugin* plugin_ = nullptr;
  ControllerKind kind_{};
};

/// Where plugins are looked for: `COHORT_PLUGIN_PATH` (colon-separated), then, from the folder of the running program,
/// those of a build tree (`../lib/controllers`) and of an installation (`../lib/cohort/controllers`).
std::vector<std::filesystem::path> default_plugin_directories();

}  // namespace cohort
