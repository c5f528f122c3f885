#pragma once

#include "server/description/experiment.hpp"
#include "tools/cohort/running/run_options.hpp"

namespace cohort::tool {

/// What the command line says of recordings, in place of what the experiment says. Throws std::invalid_argument for a
/// selector that selects no robot.
void set_recorded(description::Experiment& experiment, const RecordOptions& options);

}  // namespace cohort::tool
