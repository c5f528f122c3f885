// SPDX-License-Identifier: Apache-2.0

// Repeats a run with one seed after the other until all robots have moved at least a given distance from their start.
//
//   repeat_until_good METRES SECONDS RUNS    the server's domain is $COHORT_DOMAIN, its address $COHORT_SERVER
//
// `cohort serve EXPERIMENT --paused` serves the run, and controllers drive its robots as usual; they stay attached from
// one run to the next. This program starts and pauses the run, observes it, and ends the server when it is done. It
// prints the state hash for each seed and tick: a run with the same seed has the same hash at that tick.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cohort/client.hpp>
#include <cohort/control.hpp>
#include <cohort/observer.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

namespace {

using cohort::Vector3;

struct Wanted {
  double metres = 0.0;
  std::chrono::nanoseconds time{0};  // simulated time
  std::uint64_t runs = 0;
};

// Returns the positions of the robots by their names.
std::map<std::string, Vector3> positions(cohort::Control& control) {
  std::map<std::string, Vector3> found;
  for (const std::string& entity : control.entities()) found[entity] = control.entity_state(entity).pose.position;
  return found;
}

double distance(const Vector3& a, const Vector3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

// Returns the least distance of any robot from its start.
double least_distance(cohort::Control& control, const std::map<std::string, Vector3>& begin,
                      const std::vector<cohort::ObservedRobot>& robots) {
  const std::map<std::string, Vector3> now = positions(control);
  double least = INFINITY;
  for (const cohort::ObservedRobot& robot : robots)
    least = std::min(least, distance(now.at(robot.name), begin.at(robot.name)));
  return least;
}

// Plays until a simulated time, and prints events. Returns false if the run ends before.
bool play_until(cohort::Control& control, cohort::Observer& observer, std::chrono::nanoseconds time,
                std::uint32_t run) {
  control.play();
  while (!observer.ended()) {
    const auto state = observer.next(std::chrono::milliseconds(100));
    if (!state || state->run != run || state->time < time) continue;
    control.pause();
    return true;
  }
  return false;
}

int repeat(const Wanted& wanted) {
  cohort::ControlOptions control_options;
  cohort::ObserverOptions observer_options;
  cohort::take_environment(control_options);
  cohort::take_environment(observer_options);
  cohort::Control control(control_options);
  cohort::Observer observer(observer_options);
  control.stop_on(&cohort::stop_on_signals());
  control.pause();
  const auto robots = observer.robots(std::chrono::seconds(30));
  if (!robots) {
    std::fprintf(stderr, "the server sent no description of its robots\n");
    return 1;
  }
  int result = 1;
  for (std::uint64_t seed = 1; seed <= wanted.runs && result != 0; ++seed) {
    const std::uint32_t run = control.reset(seed).run;
    const std::map<std::string, Vector3> begin = positions(control);
    if (!play_until(control, observer, wanted.time, run)) break;
    const double least = least_distance(control, begin, *robots);
    if (least >= wanted.metres) result = 0;
    const cohort::SimulationStatus status = control.status();
    std::printf("seed %llu: %.3f m at tick %llu, hash %016llx%s\n", static_cast<unsigned long long>(seed), least,
                static_cast<unsigned long long>(status.tick), static_cast<unsigned long long>(status.state_hash),
                result == 0 ? ", is good" : "");
  }
  control.quit();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "Usage: %s METRES SECONDS RUNS\n", argv[0]);
    return 2;
  }
  try {
    const std::chrono::duration<double> time(std::stod(argv[2]));
    return repeat({std::stod(argv[1]), std::chrono::round<std::chrono::nanoseconds>(time), std::stoull(argv[3])});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "repeat_until_good: %s\n", error.what());
    return 1;
  }
}
