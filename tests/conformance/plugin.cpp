// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/plugin.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace cohort::conformance {

PluginFile::PluginFile(const std::string& path) : library_(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL), ::dlclose) {
  if (library_ != nullptr) plugin_ = static_cast<const Plugin*>(::dlsym(library_.get(), "cohort_plugin"));
  if (plugin_ == nullptr || plugin_->abi != Plugin::current_abi) {
    throw std::runtime_error(path + " is no plugin of this version");
  }
}

}  // namespace cohort::conformance
