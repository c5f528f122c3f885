// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/include/cohort/cohort_observer.h"
#include "client_sdk/include/cohort/control.hpp"
#include "client_sdk/include/cohort/observer.hpp"
#include "client_sdk/src/c_options.hpp"

struct CohortObserver {
  explicit CohortObserver(const cohort::ObserverOptions& options) : observer(options) {}

  cohort::Observer observer;
  cohort::WorldState state{};
  std::vector<CohortPose> poses{};  // poses of the state
  std::vector<cohort::ObservedRobot> robots{};
  std::vector<CohortRunEvent> events{};
};

namespace cohort {
namespace {

std::chrono::milliseconds limit_of(int milliseconds) { return std::chrono::milliseconds(std::max(milliseconds, 0)); }

// Returns the count from `ask`; -1 with the last error if there is none.
template <class Ask>
int64_t count_of(const Ask& ask) {
  try {
    if (const std::optional<std::size_t> count = ask()) return static_cast<int64_t>(*count);
    last_error() = "no answer from the server within the time limit";
  } catch (const std::exception& error) {
    last_error() = error.what();
  }
  return -1;
}

}  // namespace
}  // namespace cohort

CohortObserver* cohort_observer_connect(const CohortOptions* options) {
  return cohort::make_handle<CohortObserver, cohort::ObserverOptions>(options, "observer");
}
void cohort_observer_close(CohortObserver* observer) { delete observer; }

bool cohort_observer_next(CohortObserver* observer, int milliseconds) {
  auto state = observer->observer.next(cohort::limit_of(milliseconds));
  if (!state) return false;
  observer->state = std::move(*state);
  observer->poses.clear();
  for (const cohort::ObservedPose& robot : observer->state.robots)
    observer->poses.push_back(cohort::pose_in_c(robot.pose));
  return true;
}
int cohort_observer_descriptor(const CohortObserver* observer) { return observer->observer.descriptor(); }

uint32_t cohort_observer_run(const CohortObserver* observer) { return observer->state.run; }
uint64_t cohort_observer_tick(const CohortObserver* observer) { return observer->state.tick; }
int64_t cohort_observer_time_ns(const CohortObserver* observer) { return observer->state.time.count(); }
uint64_t cohort_observer_state_hash(const CohortObserver* observer) { return observer->state.state_hash; }
size_t cohort_observer_poses(const CohortObserver* observer) { return observer->poses.size(); }
const CohortPose* cohort_observer_pose(const CohortObserver* observer, size_t index, uint32_t* robot) {
  if (index < observer->poses.size() && robot != nullptr) *robot = observer->state.robots[index].robot;
  return cohort::at(observer->poses, index);
}

CohortObserverEnd cohort_observer_ended(const CohortObserver* observer) {
  const auto ended = observer->observer.ended();
  if (!ended) return cohort_observer_goes_on;
  cohort::last_error() = ended->how.empty() ? ended->why : ended->how + (ended->why.empty() ? "" : ": " + ended->why);
  return ended->end == cohort::ObserverEnd::run_ended ? cohort_observer_run_ended : cohort_observer_server_gone;
}

int64_t cohort_observer_ask_robots(CohortObserver* observer, int milliseconds) {
  return cohort::count_of([&]() -> std::optional<std::size_t> {
    auto robots = observer->observer.robots(cohort::limit_of(milliseconds));
    if (!robots) return std::nullopt;
    observer->robots = std::move(*robots);
    return observer->robots.size();
  });
}
const char* cohort_observer_robot(const CohortObserver* observer, size_t index, uint32_t* robot) {
  const auto* const found = cohort::at(observer->robots, index);
  if (found != nullptr && robot != nullptr) *robot = found->robot;
  return found == nullptr ? nullptr : found->name.c_str();
}
const char* cohort_observer_model(const CohortObserver* observer, size_t index) {
  const auto* const found = cohort::at(observer->robots, index);
  return found == nullptr ? nullptr : found->model.c_str();
}
const char* cohort_observer_team(const CohortObserver* observer, size_t index) {
  const auto* const found = cohort::at(observer->robots, index);
  return found == nullptr ? nullptr : found->team.c_str();
}

int64_t cohort_observer_ask_events(CohortObserver* observer, int milliseconds) {
  return cohort::count_of([&]() -> std::optional<std::size_t> {
    auto history = observer->observer.events(cohort::limit_of(milliseconds));
    if (!history) return std::nullopt;
    observer->events.clear();
    for (cohort::RunEvent& event : history->events) observer->events.push_back({std::move(event)});
    return observer->events.size();
  });
}
const CohortRunEvent* cohort_observer_event(const CohortObserver* observer, size_t index) {
  return cohort::at(observer->events, index);
}
