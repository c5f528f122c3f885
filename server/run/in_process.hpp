// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "server/run/run.hpp"

namespace cohort::session {

/// Runs an experiment with its controllers in this process, without a network: the same barrier, frames and answers as
/// over DDS. `controllers`: one for each team, in order. Robots that join during the run are admitted at that boundary:
/// `RunListener::stepped` may spawn them with `Simulation::act`. Returns when the run is over or soon after `stop` is
/// set.
RunResult run_in_process(const description::Experiment& experiment, Simulation& simulation,
                         const std::vector<ControllerKind>& controllers, const RunOptions& options,
                         const RunListener& listener, const std::atomic<bool>& stop);

}  // namespace cohort::session
