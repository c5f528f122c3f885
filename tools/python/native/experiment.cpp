// SPDX-License-Identifier: Apache-2.0
#include "server/description/experiment.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/python/hosting/unlocked.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/run_world.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

namespace nb = nanobind;
namespace fs = std::filesystem;
using description::Experiment;
using ExperimentPtr = std::shared_ptr<const Experiment>;

std::optional<std::chrono::nanoseconds> nanoseconds_of(std::optional<double> seconds) {
  if (!seconds) return std::nullopt;
  constexpr double longest = 9e9;  // about 285 years, and less than 2^63 ns
  if (!(*seconds >= 0.0 && *seconds <= longest))
    throw std::invalid_argument("duration is " + std::to_string(*seconds) + ", expected 0 to 9e9 s");
  return std::chrono::nanoseconds(std::llround(*seconds * 1e9));
}

double seconds_of(std::chrono::nanoseconds time) { return std::chrono::duration<double>(time).count(); }

ExperimentPtr read(const fs::path& file, std::optional<std::uint64_t> seed, std::optional<double> duration,
                   const std::vector<fs::path>& model_folders) {
  const auto time = nanoseconds_of(duration);
  const Unlocked unlocked;
  return std::make_shared<const Experiment>(parsing::read_experiment(file, seed, time, model_folders));
}

ExperimentPtr read_texts(const std::vector<std::pair<std::string, std::string>>& texts,
                         std::optional<std::uint64_t> seed, std::optional<double> duration,
                         const std::vector<fs::path>& model_folders) {
  const auto time = nanoseconds_of(duration);
  std::vector<description::KeptFile> files;
  for (const auto& [path, text] : texts) files.push_back({path, text});
  const Unlocked unlocked;
  return std::make_shared<const Experiment>(parsing::read_experiment_texts(files, seed, time, model_folders));
}

// As a tuple of Python's own objects, for pickle. Throws std::invalid_argument if the experiment was not read from
// files.
nb::tuple kept_files_of(const Experiment& experiment) {
  if (experiment.inputs == nullptr) throw std::invalid_argument("this experiment was not read from files");
  const description::KeptFiles& kept = *experiment.inputs;
  nb::list files;
  for (const description::KeptFile& file : kept.files)
    files.append(nb::make_tuple(file.path, nb::bytes(file.bytes.data(), file.bytes.size())));
  return nb::make_tuple(kept.experiment, kept.working_folder, kept.model_path, kept.last_model_folders, kept.folders,
                        files, experiment.seed, experiment.duration.count(), kept.settings);
}

// Reads the experiment again with further settings. Throws std::invalid_argument if it was not read from files.
ExperimentPtr with_settings(const Experiment& experiment, const std::vector<std::string>& settings) {
  if (experiment.inputs == nullptr) throw std::invalid_argument("this experiment was not read from files");
  auto inputs = std::make_shared<description::KeptFiles>(*experiment.inputs);
  inputs->settings.insert(inputs->settings.end(), settings.begin(), settings.end());
  const auto sets = [&](const char* key) {
    return std::ranges::any_of(settings, [&](const std::string& text) { return text.starts_with(key); });
  };
  const auto seed = sets("seed=") ? std::nullopt : std::optional(experiment.seed);
  const auto duration = sets("duration=") ? std::nullopt : std::optional(experiment.duration);
  const Unlocked unlocked;
  return std::make_shared<const Experiment>(parsing::read_experiment(inputs, seed, duration));
}

ExperimentPtr read_kept_files(const nb::tuple& kept) {
  auto inputs = std::make_shared<description::KeptFiles>();
  inputs->experiment = nb::cast<std::string>(kept[0]);
  inputs->working_folder = nb::cast<std::string>(kept[1]);
  inputs->model_path = nb::cast<std::string>(kept[2]);
  inputs->last_model_folders = nb::cast<std::vector<std::string>>(kept[3]);
  inputs->folders = nb::cast<std::vector<std::string>>(kept[4]);
  for (const nb::handle file : nb::cast<nb::list>(kept[5])) {
    const auto bytes = nb::cast<nb::bytes>(file[1]);
    inputs->files.push_back({nb::cast<std::string>(file[0]), std::string(bytes.c_str(), bytes.size())});
  }
  const auto seed = nb::cast<std::uint64_t>(kept[6]);
  const std::chrono::nanoseconds duration(nb::cast<std::int64_t>(kept[7]));
  inputs->settings = nb::cast<std::vector<std::string>>(kept[8]);
  const Unlocked unlocked;
  return std::make_shared<const Experiment>(parsing::read_experiment(inputs, seed, duration));
}

nb::list teams_of(const Experiment& experiment) {
  nb::list teams;
  for (const description::Team& team : experiment.teams) {
    nb::dict dictionary;
    dictionary["name"] = team.name;
    dictionary["robots"] = team.robots;
    dictionary["controller"] = team.controller;
    dictionary["period"] = team.policy.period;
    teams.append(dictionary);
  }
  return teams;
}

}  // namespace

void add_experiment(nb::module_& module) {
  nb::exception<description::InputError>(module, "InputError", PyExc_ValueError);
  nb::exception<SnapshotError>(module, "SnapshotError", PyExc_ValueError);

  nb::class_<Experiment>(module, "Experiment")
      .def_static("read", &read, nb::arg("file"), nb::arg("seed"), nb::arg("duration"), nb::arg("model_folders"))
      .def_static("read_texts", &read_texts, nb::arg("texts"), nb::arg("seed"), nb::arg("duration"),
                  nb::arg("model_folders"))
      .def("kept_files", &kept_files_of)
      .def_static("read_kept_files", &read_kept_files, nb::arg("kept"))
      .def("with_settings", &with_settings, nb::arg("settings"))
      .def("with_seed",
           [](const ExperimentPtr& experiment, std::uint64_t seed) { return session::with_seed(experiment, seed); })
      .def_ro("name", &Experiment::name)
      .def_ro("seed", &Experiment::seed)
      .def_prop_ro("file", [](const Experiment& experiment) { return experiment.file; })
      .def_prop_ro("step", [](const Experiment& experiment) { return seconds_of(experiment.world.step); })
      .def_prop_ro("duration", [](const Experiment& experiment) { return seconds_of(experiment.duration); })
      .def_prop_ro("teams", &teams_of)
      .def_prop_ro("robots",
                   [](const Experiment& experiment) {
                     nb::list names;
                     for (std::uint32_t robot = 0; robot < experiment.world.robots.size(); ++robot)
                       names.append(experiment.world.robot(robot).name);
                     return names;
                   })
      .def_prop_ro("warnings", [](const Experiment& experiment) {
        nb::list texts;
        for (const description::Problem& warning : experiment.world.warnings) texts.append(warning.text());
        return texts;
      });
}

}  // namespace cohort::python
