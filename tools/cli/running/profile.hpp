// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/core/tick_stage.hpp"
#include "server/run/run.hpp"

namespace cohort::tool {

/// Returns a table of where the wall time of a run went, and of the solver's work, as lines of text.
std::string profile_text(const session::RunResult& result, const StageTimes& times);

}  // namespace cohort::tool
