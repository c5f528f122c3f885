#include "server/session/in_process.hpp"

#include <memory>
#include <thread>

#include "server/session/exchange.hpp"
#include "server/session/roster.hpp"

namespace cohort::session {

RunResult run_in_process(const description::Experiment& experiment, Simulation& simulation,
                         const std::vector<ControllerKind>& controllers, const RunOptions& options,
                         const RunListener& listener, const std::atomic<bool>& stop) {
  RunBook book(experiment, simulation, options, listener);
  Exchange exchange(simulation);
  const std::vector<wire::RobotDescription> descriptions = describe_kinds(simulation);

  std::vector<std::unique_ptr<ControllerHost>> hosts;
  try {
    for (std::size_t team = 0; team < experiment.teams.size(); ++team) {
      wire::Admit admit;
      admit.client = team;
      admit.step_ns = experiment.world.step.count();
      admit.tick = simulation.tick();
      admit_robots(admit, experiment, simulation, experiment.teams[team].robots);
      hosts.push_back(std::make_unique<ControllerHost>(controllers[team]));
      hosts.back()->start(admit, descriptions);
    }

    book.start();
    Exchange::Frame frame;
    while (!book.is_over()) {
      if (stop) return book.finish(RunResult::End::interrupted);
      const auto begin = RunBook::Clock::now();
      exchange.open(begin.time_since_epoch());
      book.at_boundary();
      for (std::size_t team = 0; team < hosts.size(); ++team) {
        exchange.fill_frame(frame, experiment.teams[team].robots, simulation.tick());
        if (frame.robots.empty()) continue;
        wire::Observation observation;
        observation.tick = simulation.tick();
        observation.time_ns = simulation.time().count();
        observation.robots = frame.robots;
        observation.values = frame.values;
        const auto taken = exchange.take(experiment.teams[team].robots, simulation.tick(), frame.robots,
                                         hosts[team]->answer(observation));
        if (!taken.is_fault) continue;
        book.add_event("rejected", taken.rejection->reason + ": " + taken.rejection->text);
        if (taken.ends_run) return book.finish(RunResult::End::failed, taken.rejection->text);
      }
      book.add_barrier(RunBook::Clock::now() - begin);
      book.commanded(exchange.apply());
      try {
        simulation.step();
      } catch (const std::runtime_error& error) {
        book.add_event("stopped", error.what());
        return book.finish(RunResult::End::failed, error.what());
      }
      book.stepped();
      book.report(false, [](Progress&) {});
      if (const auto due = book.due_time()) {
        std::this_thread::sleep_until(*due);
        book.add_lateness(RunBook::Clock::now() - *due);
      }
    }
  } catch (const ControllerFailure& failure) {
    book.add_event("failed", failure.what());
    return book.finish(RunResult::End::failed, failure.what());
  }
  return book.finish(RunResult::End::finished);
}

}  // namespace cohort::session
