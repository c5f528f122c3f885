#pragma once

#include "server/recording/recorder.hpp"
#include "server/session/run.hpp"
#include "tools/cohort/commands.hpp"

namespace cohort::tool {

/// What the command line says of recordings, in place of what the experiment says. Throws std::invalid_argument for a
/// selector that selects no robot.
void set_recorded(description::Experiment& experiment, const RecordOptions& options);

/// Lets `recorder` see all that `listener` is told, before the listener's own functions. It has begun with
/// `simulation`.
void add_recorder(session::RunListener& listener, recording::Recorder& recorder);

/// How a run ended, in a word.
const char* word_of(session::RunResult::End end);

}  // namespace cohort::tool
