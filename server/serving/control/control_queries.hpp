// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/serving/control/controlled_run.hpp"
#include "server/serving/control/kept_snapshots.hpp"
#include "server/serving/control/live_recordings.hpp"
#include "server/serving/control/requests/request_ledger.hpp"

namespace cohort::session {

/// Answers requests that need no boundary: the state of a run, and data that clients send or fetch in parts. For the
/// thread of the run.
class ControlQueries {
 public:
  using Clock = RunMonitor::Clock;

  /// The arguments must outlive this object.
  ControlQueries(RequestLedger& ledger, LiveRecordings& recordings, const KeptSnapshots& kept)
      : ledger_(ledger), recordings_(recordings), kept_(kept) {}

  /// Starts to answer for `run`, which must outlive all further calls.
  void begin(const ControlledRun& run);
  /// Updates the real-time factor; to be called often.
  void note_progress(Clock::time_point now);
  /// Fills in the reply to a query, or the reason why there is no answer.
  void answer(wire::Reply& reply, const wire::Request& request);

 private:
  // One function for each query. Queries without a function request only data that every reply contains.
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetSimulatorFeatures&) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetEntities& operation) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetEntityState& operation) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetStatus&);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::GetData& operation) const;
  void fill(wire::Reply& reply, const wire::Request& request, const wire::PutData& part);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::GetRecording& operation);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::StopRecording&);
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetHistory& operation) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetExperiment& operation);
  std::optional<std::uint32_t> find_entity(wire::Reply& reply, const std::string& name) const;

  RequestLedger& ledger_;
  LiveRecordings& recordings_;
  const KeptSnapshots& kept_;
  const ControlledRun* run_ = nullptr;
  std::vector<std::byte> experiment_;  // the run's input files, encoded at the first request
  // Samples are at least half a second apart.
  struct Sample {
    Clock::time_point wall{};
    std::chrono::nanoseconds time{0};  // simulated time
  };
  Sample older_, newer_;
};

}  // namespace cohort::session
