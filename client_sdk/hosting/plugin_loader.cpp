// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/plugin_loader.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "client_sdk/hosting/controller_call.hpp"
#include "client_sdk/hosting/plugin_file.hpp"

namespace cohort {
namespace {

namespace fs = std::filesystem;

bool is_script(const std::string& name_or_path) { return name_or_path.ends_with(".py"); }

std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string names_of_plugins(const std::vector<fs::path>& directories) {
  constexpr std::size_t few = 16;
  std::set<std::string> names;
  for (const fs::path& directory : directories) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, ignored))
      if (entry.path().extension() == ".so") names.insert(entry.path().stem().string());
  }
  return names.empty() || names.size() > few ? "" : "; known: " + joined(names);
}

// Returns the message of dlopen without the path, and advice.
std::string reason_not_loaded(const fs::path& path) {
  const char* error = ::dlerror();
  std::string reason = error != nullptr ? error : "unknown error";
  if (const std::string prefix = path.string() + ": "; reason.starts_with(prefix)) reason.erase(0, prefix.size());
  if (reason.starts_with("undefined symbol"))
    return reason + ". Link the library that defines the symbol into the plugin";
  return reason;
}

fs::path existing_file(const std::string& path, const char* what) {
  std::error_code ignored;
  fs::path file = fs::absolute(path).lexically_normal();
  if (fs::is_regular_file(file, ignored)) return file;
  throw std::runtime_error("no " + std::string(what) + " at " + file.string());
}

// A plugin, and the Python file that it runs, if any.
struct ControllerFiles {
  fs::path plugin;
  fs::path script{};
};

ControllerFiles find_controller(const std::string& name_or_path, const std::vector<fs::path>& directories) {
  if (!is_script(name_or_path)) return {find_plugin(name_or_path, directories)};
  fs::path script = existing_file(name_or_path, "controller file");
  try {
    return {find_plugin("python", directories), std::move(script)};
  } catch (const std::runtime_error&) {
    throw std::runtime_error(
        "cannot run " + script.string() +
        ": controllers in Python require the Python package of Cohort, and its plugin 'python' is not "
        "installed. Install the package, or add the folder of python.so to COHORT_PLUGIN_PATH");
  }
}

}  // namespace

bool is_controller_path(const std::string& name_or_path) {
  return name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".so") || is_script(name_or_path);
}

void check_controller(const std::string& name_or_path, const std::vector<fs::path>& directories) {
  check_plugin_file(find_controller(name_or_path, directories).plugin);
}

fs::path find_plugin(const std::string& name_or_path, const std::vector<fs::path>& directories) {
  if (is_controller_path(name_or_path)) return existing_file(name_or_path, "controller plugin");
  std::error_code ignored;
  std::string tried;
  for (const fs::path& directory : directories) {
    fs::path path = (directory / (name_or_path + ".so")).lexically_normal();
    if (fs::is_regular_file(path, ignored)) return path;
    tried += (tried.empty() ? "" : ", ") + path.string();
  }
  throw std::runtime_error("unknown controller plugin '" + name_or_path + "'" + names_of_plugins(directories) +
                           ". Tried " + tried + ". Specify the plugin's path, or add its folder to COHORT_PLUGIN_PATH");
}

LoadedPlugin::LoadedPlugin(const std::string& name_or_path, const std::vector<fs::path>& directories)
    : library_(nullptr, ::dlclose) {
  ControllerFiles files = find_controller(name_or_path, directories);
  path_ = std::move(files.plugin);
  script_ = std::move(files.script);
  check_plugin_file(path_);
  {
    const Callee callee("the controller plugin " + path_.string());
    const ControllerCall under_way(callee, "its static constructors", 0);
    library_.reset(::dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL));
  }
  if (library_ != nullptr) plugin_ = static_cast<const Plugin*>(::dlsym(library_.get(), "cohort_plugin"));
  if (plugin_ == nullptr) throw std::runtime_error("cannot load " + path_.string() + ": " + reason_not_loaded(path_));
  // The first member in every version, so it can be read before the rest is trusted.
  check_plugin_abi(path_, plugin_->abi);
  if (script_.empty())
    kind_ = kind_of(*plugin_);
  else
    read_script();
}

// Reads the file now, so that errors in it are reported before any robot is claimed.
void LoadedPlugin::read_script() {
  using KindInFile = void(const char* file, ControllerKind& kind);
  const auto kind_in_file = reinterpret_cast<KindInFile*>(::dlsym(library_.get(), "cohort_kind_in_file"));
  if (kind_in_file == nullptr)
    throw std::runtime_error(path_.string() + " cannot run Python files. Install the Python package of this version");
  const Callee callee("the controller " + script_.string());
  const ControllerCall under_way(callee, "its module", 0);
  kind_in_file(script_.c_str(), kind_);
}

std::vector<fs::path> default_plugin_directories() {
  std::vector<fs::path> directories;
  if (const char* listed = std::getenv("COHORT_PLUGIN_PATH"); listed != nullptr) {
    std::string_view rest = listed;
    while (!rest.empty()) {
      const std::string_view directory = rest.substr(0, rest.find(':'));
      if (!directory.empty()) directories.emplace_back(directory);
      rest.remove_prefix(std::min(rest.size(), directory.size() + 1));
    }
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return directories;
  const fs::path bin = program.parent_path();
  directories.push_back((bin / "../lib/controllers").lexically_normal());  // in a build tree
  directories.push_back((bin / COHORT_LIB_FROM_BIN / "cohort/controllers").lexically_normal());
  return directories;
}

}  // namespace cohort
