// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "idl/dds/transport.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::session {

/// Publishes each tick's state hash and poses to observers: docs/protocol.md, "WorldState". Does nothing without
/// observers. For the thread that steps.
class WorldStateBroadcast {
 public:
  WorldStateBroadcast(wire::Participant& participant, const std::string& partition) : writer_(participant, partition) {}

  /// Publishes a boundary.
  void publish(const Simulation& simulation, std::uint32_t run);

 private:
  using Clock = std::chrono::steady_clock;

  wire::Writer<wire::WorldState> writer_;
  Clock::time_point observers_counted_at_{};
  bool is_observed_ = false;
  std::vector<double> poses_;           // reused
  std::vector<std::uint32_t> present_;  // reused
};

}  // namespace cohort::session
