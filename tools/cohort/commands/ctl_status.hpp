#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "idl/control_messages.hpp"

/// How `cohort ctl status` shows the reply to GetStatus.
namespace cohort::tool {

/// For people: some lines on the run, and a table with a line for each controller.
std::string status_text(const wire::Reply& reply);
/// For programs: docs/cli.md.
nlohmann::ordered_json status_json(const wire::Reply& reply);

/// A word for a state.
std::string word_of(wire::SimulationState state);

}  // namespace cohort::tool
