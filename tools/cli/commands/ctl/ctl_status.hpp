// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/control.hpp>
#include <string>

/// Output of `cohort ctl status`.
namespace cohort::tool {

/// Returns some lines on the run, and a table with a line for each controller.
std::string status_text(const SimulationStatus& status);
/// Returns JSON, as described in docs/cli.md. `indent`: spaces per level; -1: all in one line.
std::string status_json(const SimulationStatus& status, int indent);

/// Returns the name of a state.
std::string word_of(SimulationState state);

}  // namespace cohort::tool
