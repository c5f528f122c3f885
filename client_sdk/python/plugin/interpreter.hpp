#pragma once

#include "client_sdk/python/hosting/file_controllers.hpp"

namespace cohort::python {

/// Returns the controllers of the Python package in the interpreter that this process embeds: the environment variable
/// `COHORT_PYTHON`, or else `python3`. The first call starts the interpreter, which runs until the process ends,
/// handles no signals, and leaves its lock free. Thread-safe. Throws std::runtime_error, with the interpreter and
/// advice, if it cannot be embedded or lacks the package.
const FileControllers& controllers_of_package();

}  // namespace cohort::python
