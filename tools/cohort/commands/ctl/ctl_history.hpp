#pragma once

#include <chrono>
#include <string>

#include "idl/messages/run_history.hpp"

/// How `cohort ctl history` puts the replies to GetHistory together and shows them; `step` is that of the run.
namespace cohort::tool {

/// Puts what came later to what is known; events stay in the order of their first time.
void add(messages::RunHistory& history, messages::RunHistory later);

/// For people: a line for each event, by its first time, and one on how far back the run can go.
std::string history_text(const messages::RunHistory& history, std::chrono::nanoseconds step);
/// For programs: docs/cli.md.
std::string history_json(const messages::RunHistory& history, std::chrono::nanoseconds step);

}  // namespace cohort::tool
