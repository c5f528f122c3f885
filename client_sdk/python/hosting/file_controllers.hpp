// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client_sdk/hosting/controller_host.hpp"
#include "idl/include/cohort/version.h"

namespace cohort::python {

/// Access to controllers that are classes in Python files. The extension module exports this struct in a capsule, where
/// the plugin `python` finds it.
struct FileControllers {
  static constexpr const char* capsule = "cohort._native.file_controllers";

  const char* version = COHORT_VERSION;  ///< first in every version; the rest depends on the version
  /// Returns the factory of controllers of the class in `file`. Reads each file once. Throws std::runtime_error with
  /// the Python exception.
  ControllerKind (*kind_in)(const char* file) = nullptr;
};

extern const FileControllers file_controllers;

}  // namespace cohort::python
