// SPDX-License-Identifier: Apache-2.0
#include <cohort/controller.hpp>
#include <stdexcept>

#include "client_sdk/python/plugin/interpreter.hpp"

// The plugin with which `cohort` runs controllers in Python files.

extern "C" __attribute__((visibility("default"))) const cohort::Plugin cohort_plugin = {
    cohort::Plugin::current_abi, "python",
    []() -> cohort::Controller* {
      throw std::runtime_error(
          "the plugin 'python' cannot be used alone; use the path of a controller's file, such as wanderer.py");
    },
    [](cohort::Controller* controller) { delete controller; }};

extern "C" __attribute__((visibility("default"))) void cohort_kind_in_file(const char* file,
                                                                           cohort::ControllerKind& kind) {
  kind = cohort::python::controllers_of_package().kind_in(file);
}
