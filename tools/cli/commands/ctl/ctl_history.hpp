// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cohort/types.hpp>
#include <string>

/// Output of `cohort ctl history`. `step` is the step of the run.
namespace cohort::tool {

/// Returns a line for each event, ordered by first occurrence, and a line on the times that the run can go back to.
std::string history_text(const RunHistory& history, std::chrono::nanoseconds step);
/// Returns JSON, as described in docs/cli.md.
std::string history_json(const RunHistory& history, std::chrono::nanoseconds step);

}  // namespace cohort::tool
