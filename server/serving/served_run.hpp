#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "server/lockstep/leases.hpp"
#include "server/run/exchange.hpp"
#include "server/run/run_monitor.hpp"

namespace cohort::session {

/// One run whose controllers are clients: its robots, who drives them, and who is waited for. `exchange`, `leases`,
/// `error`, and so all functions but `robots_text` and `teams_text`, under the server's lock; else on the thread of the
/// run.
struct ServedRun {
  /// `first_epoch`: of its leases. Experiment and simulation must outlive it.
  ServedRun(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
            const RunListener& listener, std::uint32_t number, std::uint64_t first_epoch);

  const description::Experiment& experiment;
  Simulation& simulation;
  std::uint32_t number;
  RunMonitor monitor;
  Exchange exchange;
  lockstep::Leases leases;
  std::string error;                        // the first
  bool started = false;                     // from the first frame on
  std::vector<std::uint32_t> undemanding;   // robots that do not require a controller
  std::vector<bool> was_driven;             // by robot, whether somebody drove it in this run
  std::vector<std::uint32_t> descriptions;  // on the wire, by kind
  std::uint32_t robots_at_first;            // of the experiment: those beyond have come in mid-run
  std::function<bool()> can_rewind{};       // to where the state of all controllers is known
  std::string rewinds_for{};                // whose state is lost, where a team wants the run to go back for that

  void fail(const std::string& why) {
    if (error.empty()) error = why;
  }
  /// At a boundary: robots may have come to the simulation. Whether any have.
  bool add_newcomers();
  /// Whether no robot that requires a controller is without one.
  bool is_ready() const;
  /// Robots that have come in mid-run, require a controller and have never had one: the run stands still until they do.
  std::vector<std::uint32_t> undriven_newcomers() const;
  /// Robots that the run waits for: for their answers, or before it starts for their controllers. `is_held`: by whoever
  /// controls it.
  std::vector<std::uint32_t> awaited(bool is_held) const;
  /// Since the frames of this tick went out.
  std::chrono::nanoseconds waiting() const;
  bool is_awaited(std::uint64_t client) const;
  /// Ticks of unanswered frames whose answers can still act.
  std::vector<std::uint64_t> frames_under_way(const std::vector<std::uint32_t>& robots) const;
  /// Whether the frames of this tick were sent.
  bool is_out(std::uint64_t tick) const;
  /// Of the oldest frame without an answer, or of the next one.
  std::uint64_t due_tick_of(const std::vector<std::uint32_t>& robots) const;
  /// At a boundary: robots that do not require a controller are asked from now on if they have one.
  void see_who_drives();
  /// Names of the teams that these robots belong to.
  std::string teams_text(const std::vector<std::uint32_t>& robots) const;
  std::string robots_text(const std::vector<std::uint32_t>& robots) const;
};

}  // namespace cohort::session
