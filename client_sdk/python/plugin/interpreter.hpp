#pragma once

#include "client_sdk/python/hosting/file_controllers.hpp"

namespace cohort::python {

/// Returns the controllers of the Python package, in the interpreter that this process embeds: that of the environment
/// variable `COHORT_PYTHON`, or else `python3`. The first call starts it; it lives as long as the process, handles no
/// signals, and its lock is free. Any thread may call. Throws std::runtime_error that names the interpreter and says
/// what to do if it cannot be embedded, or lacks the package.
const FileControllers& controllers_of_package();

}  // namespace cohort::python
