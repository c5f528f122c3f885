// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

/// The parts of the extension module, each in its own source file. Each adds its classes to the module.
namespace cohort::python {

void add_experiment(nanobind::module_& module);
void add_simulation(nanobind::module_& module);
void add_batch(nanobind::module_& module);
void add_run(nanobind::module_& module);
void add_portable_functions(nanobind::module_& module);
void add_recordings(nanobind::module_& module);

}  // namespace cohort::python
