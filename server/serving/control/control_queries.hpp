#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "server/serving/control/controlled_run.hpp"
#include "server/serving/control/kept_snapshots.hpp"
#include "server/serving/control/live_recordings.hpp"
#include "server/serving/control/request_ledger.hpp"

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
  void fill_features(wire::Reply& reply) const;
  void fill_entities(wire::Reply& reply, const wire::Request& request) const;
  void fill_entity_state(wire::Reply& reply, const wire::Request& request) const;
  void fill_status(wire::Reply& reply);
  void fill_data(wire::Reply& reply, const wire::Request& request) const;
  void take_data(wire::Reply& reply, const wire::Request& request);
  void fill_recording(wire::Reply& reply, const wire::Request& request);
  void stop_recording(wire::Reply& reply, const wire::Request& request);
  void fill_history(wire::Reply& reply, const wire::Request& request) const;
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
