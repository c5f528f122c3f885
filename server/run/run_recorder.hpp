#pragma once

#include <vector>

#include "server/recording/recorder.hpp"
#include "server/run/run.hpp"

namespace cohort::session {

/// Lets those who are in `recorders` when something happens see all that `listener` is told, before the listener's own
/// functions. They have begun with the run's simulation. The vector must outlive the run.
void add_recorders(RunListener& listener, const std::vector<recording::Recorder*>& recorders);

/// How a run ended, in a word.
const char* word_of(RunResult::End end);

}  // namespace cohort::session
