// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "idl/wire/control_messages.hpp"
#include "server/run/run_monitor.hpp"

namespace cohort::session {

/// The part of a run that clients can see and change. Valid until the end of the run.
struct ControlledRun {
  const description::Experiment& experiment;
  Simulation& simulation;
  RunMonitor& monitor;
  std::uint32_t number = 0;
  std::function<void(wire::SimulationStatus&)> fill_status;  ///< fills in the members that only the server knows
  std::function<SessionSnapshot()> take_snapshot;            ///< at a boundary
};

}  // namespace cohort::session
