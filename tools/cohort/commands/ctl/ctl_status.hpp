#pragma once

#include <cohort/control.hpp>
#include <string>

/// How `cohort ctl status` shows the status of a run.
namespace cohort::tool {

/// For people: some lines on the run, and a table with a line for each controller.
std::string status_text(const SimulationStatus& status);
/// For programs: docs/cli.md. `indent`: of each level in spaces; -1: all in one line.
std::string status_json(const SimulationStatus& status, int indent);

/// A word for a state.
std::string word_of(SimulationState state);

}  // namespace cohort::tool
