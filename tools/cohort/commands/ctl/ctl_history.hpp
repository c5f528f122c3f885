#pragma once

#include <chrono>
#include <cohort/types.hpp>
#include <string>

/// How `cohort ctl history` shows what has happened in a run; `step` is that of the run.
namespace cohort::tool {

/// For people: a line for each event, by its first time, and one on how far back the run can go.
std::string history_text(const RunHistory& history, std::chrono::nanoseconds step);
/// For programs: docs/cli.md.
std::string history_json(const RunHistory& history, std::chrono::nanoseconds step);

}  // namespace cohort::tool
