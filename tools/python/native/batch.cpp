// SPDX-License-Identifier: Apache-2.0
#include "server/batch/batch.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "client_sdk/python/hosting/unlocked.hpp"
#include "server/viewing/picture.hpp"
#include "tools/python/native/array_simulation.hpp"
#include "tools/python/native/arrays.hpp"
#include "tools/python/native/channels.hpp"
#include "tools/python/native/one_user.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

/// A batch owned by Python, and its current user.
struct HeldBatch {
  HeldBatch(const description::Experiment& experiment, std::size_t worlds, unsigned threads)
      : batch(experiment, worlds, threads) {}
  Batch batch;
  mutable OneUser user;

  /// Returns the kind of a robot. Throws std::invalid_argument if there is no such robot.
  const RobotKind& kind_of(std::uint32_t robot) const {
    if (robot >= batch.robots()) throw std::invalid_argument(there_is_no("robot", robot, batch.robots()));
    return batch.kinds()[batch.kind_of(robot)];
  }
  /// Calls `get` with the batch, which is not stepped meanwhile. Throws std::invalid_argument if there is no such
  /// world.
  template <class Get>
  auto read_world(std::size_t world, const Get& get) const {
    const OneUser::Turn turn(user);
    if (world >= batch.worlds()) throw std::invalid_argument(there_is_no("world", world, batch.worlds()));
    return get(batch);
  }

 private:
  static std::string there_is_no(const char* what, std::size_t index, std::size_t count) {
    return "no " + std::string(what) + " " + std::to_string(index) + ", expected a number below " +
           std::to_string(count);
  }
};

std::unique_ptr<HeldBatch> make_batch(const std::shared_ptr<const description::Experiment>& experiment,
                                      std::size_t worlds, unsigned threads) {
  const Unlocked unlocked;
  return std::make_unique<HeldBatch>(*experiment, worlds, threads);
}

using Mask = nb::ndarray<const bool, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Seeds = nb::ndarray<const std::uint64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void step_batch(HeldBatch& held, std::uint64_t ticks, const std::optional<Mask>& only) {
  const OneUser::Turn turn(held.user);
  std::span<const std::uint8_t> chosen;
  if (only) chosen = {reinterpret_cast<const std::uint8_t*>(only->data()), only->shape(0)};
  std::atomic<bool> stop = false;
  const Unlocked unlocked(&stop);
  Batch& batch = held.batch;
  for (std::size_t row = 0; row < batch.worlds() * batch.robots(); ++row) {
    const RobotKind& kind = batch.kinds()[batch.kind_of(static_cast<std::uint32_t>(row % batch.robots()))];
    take_bounds_of_float32(kind.command, batch.commands().subspan(row * batch.command_size(), kind.command_size));
  }
  batch.step(ticks, chosen, &stop);
}

// Resets the worlds in the mask, each to its seed.
void reset_worlds(HeldBatch& held, const Mask& mask, const Seeds& seeds) {
  const OneUser::Turn turn(held.user);
  const std::size_t worlds = held.batch.worlds();
  if (mask.shape(0) != worlds || seeds.shape(0) != worlds)
    throw std::invalid_argument("`only` and `seeds` must each have " + std::to_string(worlds) +
                                " elements, one for each world");
  const Unlocked unlocked;
  for (std::size_t world = 0; world < worlds; ++world)
    if (mask(world)) held.batch.reset(world, seeds(world));
}

using Point = std::array<double, 3>;

nb::ndarray<nb::numpy, std::uint8_t, nb::c_contig> render(const HeldBatch& held, std::size_t world, int width,
                                                          int height, const std::optional<Point>& position,
                                                          const std::optional<Point>& target) {
  return held.read_world(world, [&](const Batch& batch) {
    const Simulation& simulation = batch.simulation(world);
    viewing::PictureCamera camera = viewing::camera_for(simulation, width / std::max(1.0, static_cast<double>(height)));
    if (position) camera.position_W = Eigen::Map<const Eigen::Vector3d>(position->data());
    if (target) camera.target_W = Eigen::Map<const Eigen::Vector3d>(target->data());
    return owned_array(viewing::draw_picture(simulation, camera, width, height),
                       {static_cast<std::size_t>(height), static_cast<std::size_t>(width), 3});
  });
}

template <class Value>
nb::ndarray<nb::numpy, const Value, nb::c_contig> rows_of(nb::handle self, std::span<const Value> values,
                                                          std::size_t columns) {
  const Batch& batch = nb::cast<HeldBatch&>(self).batch;
  return view_of(values.data(), {batch.worlds(), batch.robots(), columns}, self);
}

}  // namespace

void add_batch(nb::module_& module) {
  nb::class_<HeldBatch>(module, "Batch")
      .def(nb::new_(&make_batch), nb::arg("experiment"), nb::arg("worlds"), nb::arg("threads"))
      .def("step", &step_batch, nb::arg("ticks"), nb::arg("only").none())
      .def("reset", &reset_worlds, nb::arg("mask"), nb::arg("seeds"))
      .def("render", &render, nb::arg("world"), nb::arg("width"), nb::arg("height"), nb::arg("position").none(),
           nb::arg("target").none())
      .def_prop_ro("worlds", [](const HeldBatch& held) { return held.batch.worlds(); })
      .def_prop_ro("robots", [](const HeldBatch& held) { return held.batch.robots(); })
      .def("robot_name",
           [](const HeldBatch& held, std::uint32_t robot) {
             held.kind_of(robot);
             return held.batch.robot_name(robot);
           })
      .def("robot_model", [](const HeldBatch& held, std::uint32_t robot) { return held.kind_of(robot).model; })
      .def("observation_channels",
           [](const HeldBatch& held, std::uint32_t robot) { return channel_tuples(held.kind_of(robot).observation); })
      .def("command_channels",
           [](const HeldBatch& held, std::uint32_t robot) { return channel_tuples(held.kind_of(robot).command); })
      .def_prop_ro(
          "observations",
          [](nb::handle self) {
            const Batch& batch = nb::cast<HeldBatch&>(self).batch;
            return rows_of(self, batch.observations(), batch.observation_size());
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "commands",
          [](nb::handle self) {
            Batch& batch = nb::cast<HeldBatch&>(self).batch;
            return view_of(batch.commands().data(), {batch.worlds(), batch.robots(), batch.command_size()}, self);
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "poses", [](nb::handle self) { return rows_of(self, nb::cast<HeldBatch&>(self).batch.poses(), 7); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "done",
          [](nb::handle self) {
            const Batch& batch = nb::cast<HeldBatch&>(self).batch;
            return view_of(batch.done().data(), {batch.worlds()}, self);
          },
          nb::rv_policy::automatic)
      .def("tick",
           [](const HeldBatch& held, std::size_t world) {
             return held.read_world(world, [&](const Batch& batch) { return batch.tick(world); });
           })
      .def("state_hash", [](const HeldBatch& held, std::size_t world) {
        return held.read_world(world, [&](const Batch& batch) { return batch.hash(world); });
      });
}

}  // namespace cohort::python
