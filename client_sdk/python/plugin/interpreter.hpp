// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client_sdk/python/hosting/file_controllers.hpp"

namespace cohort::python {

/// Returns the controllers of the Python package in an embedded interpreter: the one that the environment variable
/// `COHORT_PYTHON` names, or else `python3`. The first call starts the interpreter, which runs until the process ends,
/// handles no signals, and does not hold the GIL afterwards. Thread-safe. Throws std::runtime_error, with the
/// interpreter and advice, if it cannot be embedded or lacks the package.
const FileControllers& controllers_of_package();

}  // namespace cohort::python
