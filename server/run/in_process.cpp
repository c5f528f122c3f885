// SPDX-License-Identifier: Apache-2.0
#include "server/run/in_process.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "server/run/exchange.hpp"
#include "server/run/roster.hpp"
#include "server/run/run_monitor.hpp"

namespace cohort::session {

namespace {

// Asks those of `robots` that are due at `tick`.
Exchange::Taken ask(Exchange& exchange, Exchange::Frame& frame, const description::Experiment& experiment,
                    std::span<const std::uint32_t> robots, std::uint64_t tick, FrameHandler& host) {
  exchange.fill_frame(frame, robots, tick);
  if (frame.robots.empty()) return {};
  wire::Observation observation;
  observation.tick = tick;
  observation.time_ns = (experiment.world.step * static_cast<std::int64_t>(tick)).count();
  observation.robots = frame.robots;
  observation.values = frame.values;
  const std::span<const double> answer = host.answer(observation);
  return exchange.take(robots, tick, frame.robots, answer, RunMonitor::Clock::now().time_since_epoch());
}

// Repeats the unanswered frames of a snapshot, whose controllers had not answered when it was taken.
void ask_again(Exchange& exchange, const description::Experiment& experiment, std::span<const std::uint32_t> robots,
               std::uint64_t now, FrameHandler& host) {
  std::map<std::uint64_t, std::vector<std::uint32_t>> robots_of;  // by tick
  for (const std::uint32_t robot : robots)
    for (const std::uint64_t tick : exchange.barrier().unanswered(robot))
      if (tick < now) robots_of[tick].push_back(robot);
  Exchange::Frame frame;
  for (const auto& [tick, unanswered] : robots_of) ask(exchange, frame, experiment, unanswered, tick, host);
}

// The controllers of robots of one team that joined together, at the start or later at one boundary.
struct Driven {
  std::size_t team = 0;
  std::vector<std::uint32_t> robots;
  std::unique_ptr<FrameHandler> host;
};

// Starts the controllers of each team's robots with ids from `first` on, if there are any.
std::vector<Driven> start_controllers(const Simulation& simulation, std::uint32_t first,
                                      const std::vector<ControllerKind>& controllers, wire::StartReason reason) {
  const std::vector<wire::RobotDescription> descriptions = describe_kinds(simulation);
  const description::Experiment& experiment = simulation.experiment();
  std::vector<Driven> all;
  for (std::size_t team = 0; team < experiment.teams.size(); ++team) {
    const std::vector<std::uint32_t>& robots = experiment.teams[team].robots;
    Driven driven{team, {std::ranges::lower_bound(robots, first), robots.end()}, {}};
    if (driven.robots.empty() && first > 0) continue;
    wire::Admit admit;
    admit.client = team;
    admit.step_ns = experiment.world.step.count();
    admit.tick = simulation.tick();
    admit.start_reason = reason;
    admit_robots(admit, experiment, simulation, driven.robots);
    driven.host = make_handler(controllers[team]);
    driven.host->start(admit, descriptions);
    all.push_back(std::move(driven));
  }
  return all;
}

// Throws SnapshotError if a controller cannot save.
ControllerStates states_of(const std::vector<Driven>& all, const Simulation& simulation, RunMonitor& monitor) {
  ControllerStates states(simulation.robot_count());
  for (const Driven& driven : all) {
    try {
      for (auto& [robot, state] : driven.host->save()) states[robot] = std::move(state);
    } catch (const SaveFailure& failure) {
      const std::string whose = "team '" + simulation.experiment().teams[driven.team].name + "'";
      monitor.add_unsaved(whose, whose + ": " + failure.what());
      throw SnapshotError(whose + ": " + failure.what());
    }
  }
  return states;
}

void offer_snapshot(const RunListener& listener, const std::function<SessionSnapshot()>& take) {
  if (!listener.can_save) return;
  try {
    listener.can_save(take);
  } catch (const SnapshotError&) {
    // The run notes an event, and continues.
  }
}

// Gives the controllers their states in the snapshot that the run starts from, and asks for answers that it lacks.
void load_states(const SessionSnapshot& snapshot, const std::vector<Driven>& all,
                 const description::Experiment& experiment, const Simulation& simulation, Exchange& exchange,
                 RunMonitor& monitor) {
  for (const Driven& driven : all) {
    for (const std::string& notice : driven.host->load(states_of(snapshot, driven.robots)))
      monitor.add_event("unsaved", "team '" + simulation.experiment().teams[driven.team].name + "': " + notice);
    ask_again(exchange, experiment, driven.robots, simulation.tick(), *driven.host);
  }
  monitor.note_left_out(snapshot);
}

}  // namespace

RunResult run_in_process(const description::Experiment& experiment, Simulation& simulation,
                         const std::vector<ControllerKind>& controllers, const RunOptions& options,
                         const RunListener& listener, const std::atomic<bool>& stop) {
  RunMonitor monitor(experiment, simulation, options, listener);
  Exchange exchange(simulation);
  if (options.from) restore(*options.from, exchange);
  const auto fail = [&](const std::string& why) {
    monitor.add_event("failed", why);
    return monitor.finish(RunResult::End::failed, why);
  };
  if (listener.can_fail) listener.can_fail(fail);
  try {
    std::vector<Driven> all = start_controllers(simulation, 0, controllers,
                                                options.from ? wire::StartReason::restored : wire::StartReason::first);
    std::uint32_t admitted = simulation.robot_count();
    if (options.from) load_states(*options.from, all, experiment, simulation, exchange, monitor);

    monitor.start();
    Exchange::Frame frame;  // reused
    while (!monitor.is_over()) {
      if (stop) {
        monitor.at_boundary();
        return monitor.finish(RunResult::End::interrupted);
      }
      if (simulation.robot_count() > admitted) {  // robots have joined
        exchange.add_newcomers();
        std::ranges::move(start_controllers(simulation, admitted, controllers, wire::StartReason::first),
                          std::back_inserter(all));
        admitted = simulation.robot_count();
      }
      offer_snapshot(listener, [&] {
        return take_snapshot(experiment, simulation, exchange, states_of(all, simulation, monitor));
      });
      const auto begin = RunMonitor::Clock::now();
      exchange.open(begin.time_since_epoch());
      monitor.at_boundary();
      for (const Driven& driven : all) {
        const auto taken = ask(exchange, frame, experiment, driven.robots, simulation.tick(), *driven.host);
        if (!taken.is_fault) continue;
        monitor.add_event("rejected", taken.rejection->reason + ": " + taken.rejection->text);
        for (const lockstep::Barrier::Miss& miss : exchange.barrier().take_refused()) monitor.add_miss(miss);
        if (taken.ends_run) return monitor.finish(RunResult::End::failed, taken.rejection->text);
      }
      monitor.add_barrier(RunMonitor::Clock::now() - begin);
      monitor.commanded(exchange.apply());
      try {
        simulation.step();
      } catch (const std::runtime_error& error) {
        monitor.add_event("stopped", error.what());
        return monitor.finish(RunResult::End::failed, error.what());
      }
      monitor.stepped();
      monitor.report(false, [](Progress&) {});
      if (const auto due = monitor.due_time()) {
        std::this_thread::sleep_until(*due);
        monitor.add_lateness(RunMonitor::Clock::now() - *due);
      }
    }
  } catch (const ControllerFailure& failure) {
    return fail(failure.what());
  }
  return monitor.finish(RunResult::End::finished);
}

}  // namespace cohort::session
