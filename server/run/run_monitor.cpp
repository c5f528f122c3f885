// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_monitor.hpp"

#include <algorithm>
#include <utility>

#include "idl/text/printable.hpp"

namespace cohort::session {

RunMonitor::RunMonitor(const description::Experiment& experiment, const Simulation& simulation, RunOptions options,
                       RunListener listener)
    : simulation_(simulation),
      options_(std::move(options)),
      listener_(std::move(listener)),
      robots_at_first_(static_cast<std::uint32_t>(experiment.world.robots.size())),
      step_(experiment.world.step),
      total_ticks_(static_cast<std::uint64_t>(experiment.duration / experiment.world.step)),
      start_(Clock::now()),
      pace_start_(start_),
      pace_start_time_(simulation.time()),
      last_report_(start_),
      last_report_time_(simulation.time()) {}

void RunMonitor::start() {
  for (const std::string& text : simulation_.happened()) add_event("event", text);
  started_ = true;
  start_ = Clock::now();
  last_report_ = start_;
  resume();
  if (listener_.stepped) listener_.stepped();
}

void RunMonitor::stop() {
  if (std::exchange(stopped_, true)) return;
  if (started_) result_.wall_time = Clock::now() - start_;
  if (listener_.stopped) listener_.stopped();
  see_whether_recorded();
}

void RunMonitor::stepped() {
  for (const std::string& body : simulation_.quarantined()) add_event("quarantined", body);
  for (const std::string& text : simulation_.happened()) add_event("event", text);
  see_whether_converged();
  if (listener_.stepped) listener_.stepped();
  if (is_over()) at_boundary();  // no more frames are sent
}

void RunMonitor::at_boundary() {
  if (last_boundary_ == simulation_.tick()) return;
  last_boundary_ = simulation_.tick();
  if (listener_.boundary) listener_.boundary();
  see_whether_recorded();
}

// Once a run, and without a message: the summary counts them.
void RunMonitor::see_whether_converged() {
  const auto& islands = simulation_.convergence().of_last_step;
  if (islands.empty() || std::exchange(has_noted_convergence_, true)) return;
  note("unconverged", "the contacts and joints of '" + simulation_.objects().name(islands.front().body.value) +
                          "' and what it touches were solved with an error; the summary counts such groups");
}

// Reports a failed recording at once to a user who waits for it.
void RunMonitor::see_whether_recorded() {
  if (unrecorded_ || !listener_.unrecorded) return;
  unrecorded_ = listener_.unrecorded();
  if (unrecorded_) add_event("unrecorded", *unrecorded_);
}

std::optional<RunMonitor::Clock::time_point> RunMonitor::due_time() const {
  if (options_.speed <= 0.0) return std::nullopt;
  const std::chrono::nanoseconds simulated = simulation_.time() - pace_start_time_;
  constexpr double never = 1e18;  // [ns], 30 years: for a speed of almost zero
  const double wall = std::min(static_cast<double>(simulated.count()) / options_.speed, never);
  return pace_start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::nano>(wall));
}

void RunMonitor::set_speed(double speed) {
  constexpr std::chrono::milliseconds little{100};
  const Clock::time_point now = Clock::now();
  const Clock::time_point due = due_time().value_or(now);
  pace_start_ = due > now - little ? std::min(due, now) : now;
  pace_start_time_ = simulation_.time();
  options_.speed = speed;
}

void RunMonitor::resume() {
  pace_start_ = Clock::now();
  pace_start_time_ = simulation_.time();
}

Progress RunMonitor::progress_at(Clock::time_point now) {
  Progress progress;
  progress.time = simulation_.time();
  progress.duration = step_ * static_cast<std::int64_t>(total_ticks_);
  progress.started = started_;
  progress.unrecorded = unrecorded_.has_value();
  const std::chrono::duration<double> wall = now - last_report_;
  const std::chrono::duration<double> simulated = progress.time - last_report_time_;
  progress.real_time_factor = wall.count() > 0.0 ? simulated / wall : 0.0;
  last_report_ = now;
  last_report_time_ = progress.time;
  return progress;
}

void RunMonitor::add_event(const std::string& kind, const std::string& text, std::uint64_t count) {
  const auto [event, is_news] = note(kind, text, count);
  if (is_news && listener_.news) listener_.news(event);
}

std::pair<RunEvent, bool> RunMonitor::note(const std::string& kind, const std::string& text, std::uint64_t count) {
  constexpr std::size_t longest = 4096;
  const RunEvent event{simulation_.tick(), kind, printable(text, longest), count};
  const bool is_news = log_.add(event.tick, kind, event.text, count);
  if (listener_.event) listener_.event(event);
  return {event, is_news};
}

void RunMonitor::controlled(ControlEvent event) {
  event.text = printable(event.text);
  add_event("control", event.operation + ": " + event.text);
  if (listener_.control) listener_.control(event);
}

void RunMonitor::add_unsaved(const std::string& whose, const std::string& why) {
  add_event("unsaved", "no snapshot could be taken: " + unsaved_.try_emplace(whose, why).first->second);
}

void RunMonitor::add_miss(const lockstep::Barrier::Miss& miss) {
  constexpr std::size_t most_misses = 1'000'000;
  ++result_.late;
  const Miss noted{simulation_.tick(), miss.frame_tick, miss.robot, miss.consequence, miss.waited};
  if (result_.misses.size() < most_misses) result_.misses.push_back(noted);
  if (listener_.miss) listener_.miss(noted);
  add_event("missed", simulation_.robot_name(miss.robot) +
                          (miss.refused ? " gave an invalid answer" : " did not answer in time"));
}

RunResult RunMonitor::finish(RunResult::End end, const std::string& error) {
  stop();
  const bool needs_more = unrecorded_ && options_.needs_recording && end == RunResult::End::finished;
  result_.end = needs_more ? RunResult::End::failed : end;
  result_.error = printable(needs_more ? *unrecorded_ : error, std::string::npos, Lines::kept);
  result_.unrecorded = printable(unrecorded_.value_or(""), std::string::npos, Lines::kept);
  result_.stop_reason = printable(simulation_.stop_reason().value_or(""));
  result_.ticks = simulation_.tick();
  result_.sim_time = simulation_.time();
  result_.state_hash = simulation_.state_hash();
  result_.robots = simulation_.robot_count();
  result_.newcomers.clear();
  for (std::uint32_t robot = robots_at_first_; robot < result_.robots; ++robot)
    result_.newcomers.push_back(simulation_.robot_name(robot));
  result_.touches = simulation_.touches();
  result_.convergence = simulation_.convergence();
  result_.events.assign(log_.events().begin(), log_.events().end());
  return result_;
}

}  // namespace cohort::session
