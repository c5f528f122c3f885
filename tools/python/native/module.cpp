// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "client_sdk/math/library_calls.hpp"
#include "client_sdk/math/portable_math.hpp"
#include "client_sdk/python/hosting/file_controllers.hpp"
#include "client_sdk/python/hosting/unlocked.hpp"
#include "idl/include/cohort/version.h"
#include "tools/python/native/parts.hpp"

NB_MODULE(_native, module) {
  nanobind::set_leak_warnings(false);  // about objects that are alive when Python exits
  cohort::python::watch_for_the_end_of_python();
  cohort::bind_library_calls();
  module.attr("version") = COHORT_VERSION;
  module.def("bind_process_calls", &cohort::bind_process_calls);
  module.def("release_process_calls", &cohort::release_process_calls);
  module.def("functions_not_portable", &cohort::functions_not_portable);
  using cohort::python::FileControllers;
  module.attr("file_controllers") = nanobind::capsule(&cohort::python::file_controllers, FileControllers::capsule);
  cohort::python::add_experiment(module);
  cohort::python::add_simulation(module);
  cohort::python::add_batch(module);
  cohort::python::add_run(module);
  cohort::python::add_portable_functions(module);
  cohort::python::add_recordings(module);
}
