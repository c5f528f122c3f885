#pragma once

#include "client_sdk/hosting/controller_host.hpp"

namespace cohort::python {

/// Controllers of classes in files of Python. The extension module has it as a capsule, in which the plugin `python`
/// finds it.
struct FileControllers {
  static constexpr const char* capsule = "cohort._native.file_controllers";

  const char* version = COHORT_VERSION;  ///< first in every version; the rest is that of the plugin's version alone
  /// Returns how to make controllers of the class that a file defines. Reads each file once. Throws std::runtime_error
  /// with what Python raises.
  ControllerKind (*kind_in)(const char* file) = nullptr;
};

extern const FileControllers file_controllers;

}  // namespace cohort::python
