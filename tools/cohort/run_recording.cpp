#include "tools/cohort/run_recording.hpp"

#include <algorithm>
#include <set>

#include "server/description/select_robots.hpp"
#include "tools/cohort/wording.hpp"

namespace cohort::tool {

void set_recorded(description::Experiment& experiment, const RecordOptions& options) {
  description::Recorded& recorded = experiment.recorded;
  recorded.pose_rate = options.pose_rate.value_or(recorded.pose_rate);
  recorded.observation_rate = options.observation_rate.value_or(recorded.observation_rate);
  if (options.snapshot_interval)
    recorded.snapshot_interval =
        std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(*options.snapshot_interval));
  if (options.robots.empty()) return;
  std::set<std::uint32_t> robots;
  for (const std::string& selector : options.robots)
    for (const std::uint32_t robot : description::select_robots(experiment.world, selector)) robots.insert(robot);
  recorded.observed.assign(robots.begin(), robots.end());
}

void add_recorder(session::RunListener& listener, recording::Recorder& recorder) {
  listener.event = [&recorder, next = listener.event](const session::Event& event) {
    recorder.event(event.kind, event.text, event.count);
    if (next) next(event);
  };
  listener.miss = [&recorder, next = listener.miss](const session::Miss& miss) {
    recorder.miss({miss.tick, miss.frame_tick, miss.robot, word_of(miss.consequence),
                   std::chrono::duration<double>(miss.waited).count()});
    if (next) next(miss);
  };
  listener.boundary = [&recorder, next = listener.boundary] {
    recorder.boundary();
    if (next) next();
  };
  listener.control = [&recorder, next = listener.control](const session::ControlEvent& event) {
    if (!event.action.empty()) recorder.action(event.text, event.action);
    if (next) next(event);
  };
  listener.commands = [&recorder, next = listener.commands](std::span<const std::uint32_t> robots) {
    recorder.commands(robots);
    if (next) next(robots);
  };
}

const char* word_of(session::RunResult::End end) {
  switch (end) {
    case session::RunResult::End::finished: return "finished";
    case session::RunResult::End::interrupted: return "interrupted";
    case session::RunResult::End::failed: return "failed";
    case session::RunResult::End::shut_down: return "shut_down";
    case session::RunResult::End::reset: return "reset";
    case session::RunResult::End::restored: return "restored";
  }
  return "unknown";
}

}  // namespace cohort::tool
