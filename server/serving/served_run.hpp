// SPDX-License-Identifier: Apache-2.0
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

/// One run whose controllers are clients: its robots, the clients that drive them, and the robots that it waits for.
/// `exchange`, `leases`, `error`, and all functions except `robots_text` and `teams_text`, require the server's lock;
/// the rest is for the thread of the run.
struct ServedRun {
  /// `first_epoch`: epoch of its first lease. Experiment and simulation must outlive this object.
  ServedRun(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
            const RunListener& listener, std::uint32_t number, std::uint64_t first_epoch);

  const description::Experiment& experiment;
  Simulation& simulation;
  std::uint32_t number;
  RunMonitor monitor;
  Exchange exchange;
  lockstep::Leases leases;
  std::string error;                        // the first error
  bool started = false;                     // true from the first frame on
  std::vector<std::uint32_t> undemanding;   // robots that do not require a controller
  std::vector<bool> was_driven;             // by robot: a client drove it in this run
  std::vector<std::uint32_t> descriptions;  // ids on the wire, by kind
  std::uint32_t robots_at_first;            // robots of the experiment; later ones joined during the run
  std::function<bool()> can_rewind{};       // to a tick at which the state of all controllers was saved
  std::string rewinds_for{};                // reason to go back: lost state that a team's policy does not accept

  void fail(const std::string& why) {
    if (error.empty()) error = why;
  }
  /// Adds robots that joined the simulation at a boundary. Returns true if there were any.
  bool add_newcomers();
  /// Returns true if a robot that joined during the run has left it for good, and its last frames are answered.
  bool is_gone(std::uint32_t robot) const;
  /// Returns true if every robot that requires a controller has one.
  bool is_ready() const;
  /// Returns the robots that joined during the run, require a controller and have never had one: the run is paused
  /// until they have.
  std::vector<std::uint32_t> undriven_newcomers() const;
  /// Returns the robots that the run waits for: for their answers, or before the start for their controllers.
  /// `is_held`: a client that controls the run holds it.
  std::vector<std::uint32_t> awaited(bool is_held) const;
  /// Returns the time since the frames of this tick were sent.
  std::chrono::nanoseconds waiting() const;
  bool is_awaited(std::uint64_t client) const;
  /// Returns the ticks of unanswered frames whose answers can still have an effect.
  std::vector<std::uint64_t> frames_under_way(const std::vector<std::uint32_t>& robots) const;
  /// Returns true if the frames of this tick were sent.
  bool is_out(std::uint64_t tick) const;
  /// Returns the tick of the oldest unanswered frame, or of the next frame.
  std::uint64_t due_tick_of(const std::vector<std::uint32_t>& robots) const;
  /// Updates, at a boundary, which of the robots that do not require a controller have one, and so receive frames from
  /// now on.
  void see_who_drives();
  /// Returns the names of the teams of these robots.
  std::string teams_text(const std::vector<std::uint32_t>& robots) const;
  std::string robots_text(const std::vector<std::uint32_t>& robots) const;
};

}  // namespace cohort::session
