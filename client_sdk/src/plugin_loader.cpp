#include "client_sdk/src/plugin_loader.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace cohort {
namespace {

namespace fs = std::filesystem;

// A name is looked for, a path is taken as it is.
bool is_path(const std::string& name_or_path) {
  return name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".so");
}

fs::path find_plugin(const std::string& name_or_path, const std::vector<fs::path>& directories) {
  std::vector<fs::path> candidates;
  if (is_path(name_or_path)) {
    candidates.push_back(fs::absolute(name_or_path));
  } else {
    for (const fs::path& directory : directories) candidates.push_back(directory / (name_or_path + ".so"));
  }
  std::string tried;
  for (const fs::path& candidate : candidates) {
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate;
    tried += "\n  " + candidate.lexically_normal().string();
  }
  throw std::runtime_error("there is no controller plugin '" + name_or_path + "'. Tried:" + tried +
                           "\nGive its path, or put its folder into COHORT_PLUGIN_PATH.");
}

}  // namespace

LoadedPlugin::LoadedPlugin(const std::string& name_or_path, const std::vector<fs::path>& directories)
    : path_(find_plugin(name_or_path, directories)),
      library_(::dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL), ::dlclose) {
  if (library_ == nullptr) {
    const char* reason = ::dlerror();
    throw std::runtime_error("cannot load " + path_.string() + ": " + (reason != nullptr ? reason : "unknown error"));
  }
  plugin_ = static_cast<const Plugin*>(::dlsym(library_.get(), "cohort_plugin"));
  if (plugin_ == nullptr) {
    throw std::runtime_error(path_.string() +
                             " is not a controller plugin: it lacks the symbol cohort_plugin, which "
                             "COHORT_CONTROLLER(Class) at the end of the controller's source makes");
  }
  // First in the struct in every version, so it can be read before anything else is trusted.
  if (plugin_->abi != Plugin::current_abi) {
    throw std::runtime_error(path_.string() + " was built for version " + std::to_string(plugin_->abi) +
                             " of the controller interface, and this program has version " +
                             std::to_string(Plugin::current_abi) +
                             ". Build it again with the headers of this version.");
  }
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
