// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_recorder.hpp"

namespace cohort::session {

using recording::Recorder;

void add_recorders(RunListener& listener, const std::vector<Recorder*>& recorders) {
  listener.event = [&recorders, next = listener.event](const RunEvent& event) {
    for (Recorder* recorder : recorders) recorder->event(event.kind, event.text, event.count);
    if (next) next(event);
  };
  listener.miss = [&recorders, next = listener.miss](const Miss& miss) {
    for (Recorder* recorder : recorders)
      recorder->miss({miss.tick, miss.frame_tick, miss.robot, word_of(miss.consequence),
                      std::chrono::duration<double>(miss.waited).count()});
    if (next) next(miss);
  };
  listener.boundary = [&recorders, next = listener.boundary] {
    for (Recorder* recorder : recorders) recorder->boundary();
    if (next) next();
  };
  listener.control = [&recorders, next = listener.control](const ControlEvent& event) {
    if (!event.action.empty())
      for (Recorder* recorder : recorders) recorder->action(event.text, event.action);
    if (next) next(event);
  };
  listener.commands = [&recorders, next = listener.commands](std::span<const std::uint32_t> robots) {
    for (Recorder* recorder : recorders) recorder->commands(robots);
    if (next) next(robots);
  };
}

const char* word_of(RunResult::End end) {
  switch (end) {
    case RunResult::End::finished: return "finished";
    case RunResult::End::interrupted: return "interrupted";
    case RunResult::End::failed: return "failed";
    case RunResult::End::shut_down: return "shut_down";
    case RunResult::End::reset: return "reset";
    case RunResult::End::restored: return "restored";
  }
  return "unknown";
}

}  // namespace cohort::session
