// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/recording/recorder.hpp"
#include "server/run/run.hpp"

namespace cohort::session {

/// Makes `listener` pass its calls to the current elements of `recorders` first. These must have begun with the run's
/// simulation. The vector must outlive the run.
void add_recorders(RunListener& listener, const std::vector<recording::Recorder*>& recorders);

/// Returns how a run ended, as a keyword such as `finished`.
const char* word_of(RunResult::End end);

}  // namespace cohort::session
