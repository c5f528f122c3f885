// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "server/lockstep/barrier.hpp"
#include "server/run/run.hpp"

namespace cohort::session {

/// A monitor of one run, which collects its result: wall time, pace, progress reports, events. Not thread-safe.
class RunMonitor {
 public:
  using Clock = std::chrono::steady_clock;

  RunMonitor(const description::Experiment& experiment, const Simulation& simulation, RunOptions options,
             RunListener listener);

  /// Returns true if the whole duration is simulated, a stop condition is met, or a required recording has ended.
  bool is_over() const {
    return simulation_.tick() >= total_ticks_ || simulation_.stop_reason() || (unrecorded_ && options_.needs_recording);
  }
  void start();  ///< before the first frame is sent
  void stop();   ///< after the last step
  /// Notes a completed step.
  void stepped();
  /// Notes that the frames of this tick were sent.
  void at_boundary();
  void commanded(std::span<const std::uint32_t> changed) const {
    if (listener_.commands) listener_.commands(changed);
  }
  /// Reports progress if the last report is old enough, or if `now_anyway`. `complete` fills in the robots that the run
  /// waits for.
  template <class Complete>
  void report(bool now_anyway, Complete&& complete) {
    const Clock::time_point now = Clock::now();
    if (now - last_report_ >= report_interval) see_whether_recorded();
    if (!listener_.progress || (!now_anyway && now - last_report_ < report_interval)) return;
    Progress progress = progress_at(now);
    complete(progress);
    listener_.progress(progress);
  }
  Clock::time_point next_report() const { return last_report_ + report_interval; }
  /// Returns when the next tick may begin at the requested speed; nothing if no speed was requested. The time is
  /// counted from the start of the run or its last change of pace, so that simulated and wall time never drift apart.
  std::optional<Clock::time_point> due_time() const;
  /// Changes the pace, without a gap if the run kept its pace before.
  void set_speed(double speed);
  /// Excludes the wall time until now from the pace.
  void resume();
  double speed() const { return options_.speed; }
  const RunOptions& options() const { return options_; }
  std::chrono::nanoseconds duration() const { return step_ * static_cast<std::int64_t>(total_ticks_); }
  void controlled(ControlEvent event);
  const EventLog& events() const { return log_; }
  void add_event(const std::string& kind, const std::string& text, std::uint64_t count = 1);
  void add_barrier(std::chrono::nanoseconds latency) {
    result_.barrier.add(latency);
    if (listener_.barrier) listener_.barrier(latency);
  }
  /// Adds events for a snapshot that is taken or restored: for each team whose controllers' state is missing, and if
  /// the snapshot is from a build with other results.
  void note_left_out(const SessionSnapshot& snapshot) {
    if (const std::string why = why_results_differ(snapshot.build); !why.empty())
      add_event("other_build", "the snapshot: " + why);
    for (const std::string& sentence : what_is_left_out(snapshot, simulation_.experiment()))
      add_event("unsaved", sentence);
  }
  /// Notes that a snapshot cannot be taken. `whose`: controllers that cannot save; only the first reason of each is
  /// reported.
  void add_unsaved(const std::string& whose, const std::string& why);
  void add_resent(std::uint64_t frames) { result_.resent += frames; }
  void add_repeated(std::uint64_t answers) { result_.repeated += answers; }
  void add_lateness(std::chrono::nanoseconds lateness) {
    result_.lateness.add(lateness);
    if (static_cast<double>(lateness.count()) * options_.speed > static_cast<double>(step_.count()))
      ++result_.late_ticks;
  }
  void add_miss(const lockstep::Barrier::Miss& miss);
  /// Completes and returns the result. May be called again if ending the run failed.
  RunResult finish(RunResult::End end, const std::string& error = {});

 private:
  static constexpr std::chrono::milliseconds report_interval{200};
  Progress progress_at(Clock::time_point now);
  void see_whether_recorded();
  void see_whether_converged();
  // Adds an event without telling the user. Returns it, and whether it is the first of its kind and text.
  std::pair<RunEvent, bool> note(const std::string& kind, const std::string& text, std::uint64_t count = 1);

  const Simulation& simulation_;
  RunOptions options_;
  RunListener listener_;
  std::uint32_t robots_at_first_;
  std::chrono::nanoseconds step_;
  std::uint64_t total_ticks_;
  bool started_ = false;
  bool stopped_ = false;
  bool has_noted_convergence_ = false;
  std::optional<std::string> unrecorded_;       // reason
  std::optional<std::uint64_t> last_boundary_;  // the last one that was reported to the listener
  Clock::time_point start_;
  // Reference point of the pace.
  Clock::time_point pace_start_;
  std::chrono::nanoseconds pace_start_time_{0};  // simulated time
  Clock::time_point last_report_;
  std::chrono::nanoseconds last_report_time_{0};  // simulated time
  EventLog log_;
  std::map<std::string, std::string> unsaved_;  // first reason, by controllers
  RunResult result_;
};

}  // namespace cohort::session
