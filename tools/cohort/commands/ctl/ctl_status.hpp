#pragma once

#include <string>

#include "idl/wire/control_messages.hpp"

/// How `cohort ctl status` shows the reply to GetStatus.
namespace cohort::tool {

/// For people: some lines on the run, and a table with a line for each controller.
std::string status_text(const wire::Reply& reply);
/// For programs: docs/cli.md. `indent`: of each level in spaces; -1: all in one line.
std::string status_json(const wire::Reply& reply, int indent);

/// A word for a state.
std::string word_of(wire::SimulationState state);

}  // namespace cohort::tool
