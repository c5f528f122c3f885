#pragma once

#include <cstdint>
#include <functional>

#include "idl/wire/control_messages.hpp"
#include "server/run/run_monitor.hpp"

namespace cohort::session {

/// What those who control it see and change of a run. All of it is good until the end of the run.
struct ControlledRun {
  const description::Experiment& experiment;
  Simulation& simulation;
  RunMonitor& monitor;
  std::uint32_t number = 0;
  std::function<void(wire::SimulationStatus&)> fill_status;  ///< what control does not know itself
  std::function<SessionSnapshot()> take_snapshot;            ///< at a boundary
};

}  // namespace cohort::session
