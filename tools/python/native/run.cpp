// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "client_sdk/python/hosting/python_team.hpp"
#include "client_sdk/python/hosting/unlocked.hpp"
#include "server/recording/recorder.hpp"
#include "server/run/in_process.hpp"
#include "server/run/run_recorder.hpp"
#include "tools/python/native/interruption.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

namespace nb = nanobind;
namespace fs = std::filesystem;
using description::Experiment;

double seconds(std::chrono::nanoseconds time) { return std::chrono::duration<double>(time).count(); }

/// Controllers of the teams of a run: plugins and Python classes.
class TeamControllers {
 public:
  /// Loads the controllers. `controllers` has for each team, in order, the name or path of a plugin, or a maker of
  /// adapters of a Python class. Throws std::runtime_error for a plugin that cannot be loaded.
  TeamControllers(const nb::list& controllers, const std::vector<fs::path>& folders) {
    for (nb::handle controller : controllers) {
      if (nb::isinstance<nb::str>(controller)) {
        plugins_.emplace_back(nb::cast<std::string>(controller), folders);
        kinds_.push_back(plugins_.back().kind());
      } else {
        kinds_.push_back(kind_of_maker(controller.ptr()));  // `controllers` keeps it alive
      }
    }
  }

  const std::vector<ControllerKind>& kinds() const { return kinds_; }

 private:
  std::vector<LoadedPlugin> plugins_;
  std::vector<ControllerKind> kinds_;
};

nb::dict dictionary_of(const session::RunResult& result) {
  nb::list events;
  for (const session::RunEvent& event : result.events)
    events.append(nb::make_tuple(event.tick, event.kind, event.text, event.count));
  nb::dict dictionary;
  dictionary["end"] = session::word_of(result.end);
  dictionary["error"] = result.error;
  dictionary["stop_reason"] = result.stop_reason;
  dictionary["ticks"] = result.ticks;
  dictionary["time"] = seconds(result.sim_time);
  dictionary["wall_time"] = seconds(result.wall_time);
  dictionary["state_hash"] = result.state_hash;
  dictionary["robots"] = result.robots;
  dictionary["robot_ticks"] = result.touches.robot_ticks;
  dictionary["touching_obstacles"] = result.touches.obstacles;
  dictionary["touching_robots"] = result.touches.robots;
  dictionary["events"] = events;
  return dictionary;
}

nb::dict run(const std::shared_ptr<const Experiment>& experiment, unsigned threads, const nb::list& controllers,
             const std::vector<fs::path>& plugin_folders, const fs::path& record) {
  const TeamControllers drivers(controllers, plugin_folders);
  std::atomic<bool> stop = false;
  Interruption interruption;
  session::RunResult result;
  {
    const Unlocked unlocked(&stop);
    Simulation simulation(*experiment, threads);
    session::RunListener listener{.boundary = [&] {
      if (interruption.is_wanted()) stop = true;
    }};
    std::optional<recording::Recorder> recorder;
    std::vector<recording::Recorder*> recorders;
    if (!record.empty()) {
      recorders.push_back(&recorder.emplace(record, *experiment));
      recorder->begin(*experiment, simulation, recording::Beginning::first);
      session::add_recorders(listener, recorders);
    }
    result = session::run_in_process(*experiment, simulation, drivers.kinds(), {}, listener, stop);
    if (recorder) recorder->finish(session::word_of(result.end), result.error);
    if (recorder && recorder->error())
      throw std::runtime_error("the recording ended before the run: " + *recorder->error());
  }
  interruption.rethrow();
  return dictionary_of(result);
}

}  // namespace

void add_run(nb::module_& module) {
  module.def("run", &run, nb::arg("experiment"), nb::arg("threads"), nb::arg("controllers"), nb::arg("plugin_folders"),
             nb::arg("record"));
}

}  // namespace cohort::python
