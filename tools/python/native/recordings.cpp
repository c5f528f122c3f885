// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client_sdk/python/hosting/unlocked.hpp"
#include "server/recording/difference.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/recording/recording.hpp"
#include "server/recording/replay.hpp"
#include "server/recording/run_messages.hpp"
#include "tools/common/data/recording_tables.hpp"
#include "tools/python/native/arrays.hpp"
#include "tools/python/native/collected_tables.hpp"
#include "tools/python/native/interruption.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

using description::Experiment;
using recording::McapError;
using recording::Recording;

// Thrown to stop reading where there is no other way to stop it.
struct Interrupted {};

double in_seconds(std::chrono::nanoseconds time) { return std::chrono::duration<double>(time).count(); }

// Error of a file that cannot be opened. It differs from FileError, which recording to a file also throws.
class CannotBeOpened : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void raise_recording_error(const std::exception_ptr& error, void* type) {
  try {
    std::rethrow_exception(error);
  } catch (const McapError& of_file) {
    PyErr_SetString(static_cast<PyObject*>(type), of_file.what());
  } catch (const CannotBeOpened& of_file) {
    PyErr_SetString(static_cast<PyObject*>(type), of_file.what());
  }
}

std::unique_ptr<Recording> open_recording(const std::filesystem::path& file) {
  const Unlocked unlocked;
  try {
    return std::make_unique<Recording>(file);
  } catch (const recording::FileError& error) {
    throw CannotBeOpened(error.what());
  }
}

nb::list worlds_of(const Recording& recording) {
  nb::list worlds;
  for (const auto& [begins, log_time] : recording.worlds())
    worlds.append(nb::make_tuple(begins.run, begins.seed, begins.reason, begins.tick, in_seconds(log_time)));
  return worlds;
}

nb::list channels_of(const std::vector<recording::RecordedChannel>& channels) {
  nb::list list;
  for (const auto& channel : channels) list.append(nb::make_tuple(channel.name, channel.unit, channel.size));
  return list;
}

// Returns tuples (run, simulated time, kinds, robots); kinds are (model, observation, command), robots are (name, team,
// kind, command). A world has another tuple when robots were added.
nb::list rosters_of(const Recording& recording) {
  nb::list rosters;
  const recording::Channel* const channel = recording.reader().channel(recording::Roster::topic);
  const recording::Channel* const worlds = recording.reader().channel(recording::WorldBegins::topic);
  if (channel == nullptr || worlds == nullptr) return rosters;
  recording::MessageStream stream =
      recording.reader().messages({.channels = {channel->id, worlds->id}, .order = recording::Order::file});
  std::uint32_t run = 0;
  try {
    while (const auto message = stream.next()) {
      if (message->channel == worlds->id) {
        run = messages::decode<recording::WorldBegins>(message->data).run;
        continue;
      }
      const auto roster = messages::decode<recording::Roster>(message->data);
      nb::list kinds;
      for (const auto& kind : roster.kinds)
        kinds.append(nb::make_tuple(kind.model, channels_of(kind.observation), channels_of(kind.command)));
      nb::list robots;
      for (const auto& robot : roster.robots) {
        if (robot.kind >= roster.kinds.size()) throw messages::CdrError("a robot has an unknown kind");
        robots.append(nb::make_tuple(robot.name, robot.team, robot.kind, robot.command));
      }
      rosters.append(nb::make_tuple(run, in_seconds(message->publish_time), kinds, robots));
    }
  } catch (const messages::CdrError& error) {
    throw McapError(recording.file(), 0, std::string("a message is not in Cohort's format: ") + error.what());
  }
  return rosters;
}

// Returns a tuple (columns, reals, wholes, texts, text values); columns are (name, type, unit).
nb::tuple tuple_of(CollectedTable table) {
  std::size_t counts[3] = {};
  nb::list columns;
  for (const data::Column& column : table.columns) {
    constexpr const char* types[] = {"real", "whole", "text"};
    ++counts[static_cast<std::size_t>(column.type)];
    columns.append(nb::make_tuple(column.name, types[static_cast<std::size_t>(column.type)], column.unit));
  }
  return nb::make_tuple(columns, owned_array(std::move(table.reals), {table.rows, counts[0]}),
                        owned_array(std::move(table.wholes), {table.rows, counts[1]}),
                        owned_array(std::move(table.texts), {table.rows, counts[2]}), table.text_values);
}

// Returns tables by name; None instead of rows that were not requested. Returns all rows if no name is given.
nb::dict tables_of(const Recording& recording, const std::vector<std::string>& names,
                   const std::vector<std::string>& robots) {
  const std::set<std::string> kept(names.begin(), names.end());
  Interruption interruption;
  CollectedTables sink([&](const std::string& name) { return kept.contains(name); },
                       [&, rows = 0]() mutable {
                         constexpr int look_every = 1024;
                         if (++rows % look_every == 0 && interruption.is_wanted()) throw Interrupted{};
                       });
  try {
    const Unlocked unlocked;
    data::write_tables(recording, {.robots = {robots.begin(), robots.end()}}, sink);
    sink.finish();
  } catch (const Interrupted&) {
    interruption.rethrow();
  }
  nb::dict tables;
  for (auto& [name, table] : sink.tables()) {
    if (kept.contains(name))
      tables[name.c_str()] = tuple_of(std::move(table));
    else
      tables[name.c_str()] = nb::none();
  }
  return tables;
}

std::shared_ptr<const Experiment> experiment_of(const Recording& recording, std::size_t world) {
  const Unlocked unlocked;
  return std::make_shared<const Experiment>(recording.experiment(recording.worlds().at(world)));
}

// Returns (height, width) of the image of a device; None if robots of that model have no such device.
nb::object image_shape(const Recording& recording, const std::string& robot_model, const std::string& device_name) {
  const std::shared_ptr<const Experiment> experiment = experiment_of(recording, 0);
  for (const description::Model& model : experiment->world.models) {
    if (model.name != robot_model) continue;
    for (const description::Device& device : model.devices)
      if (const auto* const camera = std::get_if<description::PanoramicCamera>(&device))
        if (camera->name == device_name) return nb::make_tuple(camera->height, camera->width);
  }
  return nb::none();
}

nb::tuple verify(const Recording& recording, unsigned threads) {
  Interruption interruption;
  recording::Verification found;
  {
    const Unlocked unlocked;
    recording::Replay replay(recording, threads);
    found = recording::verify(replay, std::chrono::nanoseconds(0), std::chrono::nanoseconds::max(),
                              [&](std::chrono::nanoseconds) { return !interruption.is_wanted(); });
  }
  interruption.rethrow();
  nb::object difference = nb::none();
  if (const auto& first = found.difference)
    difference = nb::make_tuple(first->tick, in_seconds(first->log_time), first->recorded, first->replayed);
  return nb::make_tuple(found.boundaries, difference, found.problem);
}

nb::tuple compare(const Recording& first, const Recording& second, unsigned threads) {
  Interruption interruption;
  recording::Comparison found;
  {
    const Unlocked unlocked;
    found =
        recording::compare(first, second, threads, [&](std::chrono::nanoseconds) { return !interruption.is_wanted(); });
  }
  interruption.rethrow();
  if (!found.parting) return nb::make_tuple(found.boundaries, nb::none(), found.ends);
  nb::list differences;
  for (const auto& each : found.parting->differences)
    differences.append(nb::make_tuple(each.object, each.quantity, each.detail, each.first, each.second));
  return nb::make_tuple(
      found.boundaries,
      nb::make_tuple(found.parting->tick, in_seconds(found.parting->log_time), differences, found.parting->more),
      found.ends);
}

// Returns (index of the world, its state as a snapshot) at the first boundary at or after a time of the recording; None
// if there is none.
nb::object state_at(const Recording& recording, double time) {
  constexpr double longest = 9e9;  // less than 2^63 ns
  if (!(time >= 0.0 && time <= longest))
    throw nb::value_error(("time is " + std::to_string(time) + ", expected 0 to 9e9 s").c_str());
  const std::chrono::nanoseconds log_time(std::llround(time * 1e9));
  std::vector<std::byte> state;
  std::size_t world = 0;
  {
    const Unlocked unlocked;
    recording::Replay replay(recording, 1);
    if (replay.seek(log_time)) state = replay.simulation().save();
    for (std::size_t i = 0; !state.empty() && i < recording.worlds().size(); ++i)
      if (recording.worlds()[i].log_time <= replay.recorded().log_time) world = i;
  }
  if (state.empty()) return nb::none();
  return nb::make_tuple(world, nb::bytes(state.data(), state.size()));
}

}  // namespace

void add_recordings(nb::module_& module) {
  const nb::object error = nb::steal(PyErr_NewException("cohort.RecordingError", PyExc_ValueError, nullptr));
  module.attr("RecordingError") = error;
  nb::register_exception_translator(&raise_recording_error, error.ptr());  // the module keeps it alive

  nb::class_<Recording>(module, "Recording")
      .def(nb::new_(&open_recording), nb::arg("file"))
      .def_prop_ro("damage", &Recording::damage)
      .def_prop_ro("facts", &Recording::facts)
      .def_prop_ro("end", &Recording::end)
      .def_prop_ro("worlds", &worlds_of)
      .def_prop_ro("rosters", &rosters_of)
      .def_prop_ro("times",
                   [](const Recording& recording) {
                     const recording::Statistics& statistics = recording.reader().statistics();
                     return std::pair(in_seconds(std::chrono::nanoseconds(statistics.start_time)),
                                      in_seconds(std::chrono::nanoseconds(statistics.end_time)));
                   })
      .def("experiment", &experiment_of, nb::arg("world"))
      .def("tables", &tables_of, nb::arg("names"), nb::arg("robots"))
      .def("image_shape", &image_shape, nb::arg("model"), nb::arg("device"))
      .def("verify", &verify, nb::arg("threads"))
      .def("compare", &compare, nb::arg("other"), nb::arg("threads"))
      .def("state_at", &state_at, nb::arg("time"));
}

}  // namespace cohort::python
