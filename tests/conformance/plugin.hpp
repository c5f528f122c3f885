// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/controller.hpp>
#include <memory>
#include <string>

namespace cohort::conformance {

using OwnedController = std::unique_ptr<Controller, void (*)(Controller*)>;

/// The plugin of a controller. Its controllers must be destroyed before it.
class PluginFile {
 public:
  /// Throws std::runtime_error if there is none at `path`.
  explicit PluginFile(const std::string& path);
  std::string name() const { return plugin_->name; }
  OwnedController create() const { return {plugin_->create(), plugin_->destroy}; }

 private:
  std::unique_ptr<void, int (*)(void*)> library_;
  const Plugin* plugin_ = nullptr;
};

}  // namespace cohort::conformance
