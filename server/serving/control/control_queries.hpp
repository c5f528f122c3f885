#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "server/serving/control/controlled_run.hpp"
#include "server/serving/control/kept_snapshots.hpp"
#include "server/serving/control/live_recordings.hpp"
#include "server/serving/control/requests/request_ledger.hpp"

namespace cohort::session {

/// Answers what needs no boundary: the state of a run, and data in parts, to and from clients. On the thread of the
/// run.
class ControlQueries {
 public:
  using Clock = RunMonitor::Clock;

  /// All must outlive this.
  ControlQueries(RequestLedger& ledger, LiveRecordings& recordings, const KeptSnapshots& kept)
      : ledger_(ledger), recordings_(recordings), kept_(kept) {}

  /// `run` must be there for all that follows.
  void begin(const ControlledRun& run);
  /// For the real-time factor: often.
  void note_progress(Clock::time_point now);
  /// Fills in the reply to a query, or why there is no answer.
  void answer(wire::Reply& reply, const wire::Request& request);

 private:
  // One for each question. Those without one ask for what every reply says.
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetSimulatorFeatures&) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetEntities& operation) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetEntityState& operation) const;
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetStatus&);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::GetData& operation) const;
  void fill(wire::Reply& reply, const wire::Request& request, const wire::PutData& part);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::GetRecording& operation);
  void fill(wire::Reply& reply, const wire::Request& request, const wire::StopRecording&);
  void fill(wire::Reply& reply, const wire::Request&, const wire::GetHistory& operation) const;
  std::optional<std::uint32_t> find_entity(wire::Reply& reply, const std::string& name) const;

  RequestLedger& ledger_;
  LiveRecordings& recordings_;
  const KeptSnapshots& kept_;
  const ControlledRun* run_ = nullptr;
  // Half a second and more apart.
  struct Sample {
    Clock::time_point wall{};
    std::chrono::nanoseconds time{0};  // simulated
  };
  Sample older_, newer_;
};

}  // namespace cohort::session
