// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/readings/take_samples.hpp"

#include <cmath>
#include <numbers>

#include "server/description/world_in_code.hpp"
#include "server/physics/make_world.hpp"
#include "server/sensing/make_sensor.hpp"
#include "server/sensing/sensor.hpp"

namespace cohort::sensing {
namespace {

constexpr std::uint64_t random_ticks = 256;

}  // namespace

description::Samples take_samples(const description::Model& model, std::size_t device, const SampleGrid& grid) {
  const auto& ring = std::get<description::ProximityRing>(model.devices[device]);
  description::World description;
  description.models = {model, description::static_shape("cylinder", description::Cylinder{grid.radius, grid.height})};
  description.instances = {{"robot", 0, {}}, {"cylinder", 1, {}}};
  description.robots = {0};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  const emission::Emitters emitters(description, *world);
  SharedViews views;
  const gripping::Grippers grippers(description, *world);
  const auto sensor = make_sensor({*world, emitters, description, grippers, views, BodyId{0}, DeviceId{device}, 1});
  const std::uint64_t ticks = ring.technique == description::ProximityTechnique::random_ray ? random_ticks : 1;

  description::Samples samples;
  for (const Channel& channel : sensor->channels()) samples.units.push_back(channel.unit);
  for (std::size_t i = 0; i < grid.angles; ++i)
    samples.angles.push_back(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(grid.angles));
  for (std::size_t i = 0; i < grid.distances; ++i)
    samples.distances.push_back(ring.ring_radius +
                                ring.range * static_cast<double>(i) / static_cast<double>(grid.distances - 1));
  const Pose X_WS = world->link_pose(BodyId{0}, LinkId{ring.link}) * ring.X_LS;
  std::vector<double> values(ring.count);
  for (const double distance : samples.distances)
    for (const double angle : samples.angles) {
      const double away = distance + grid.radius;
      Pose X_WC;
      X_WC.position = X_WS * Eigen::Vector3d(away * std::cos(angle), away * std::sin(angle), 0.0);
      world->place_body(BodyId{1}, X_WC);
      std::vector<double> sums(ring.count);
      for (std::uint64_t tick = 0; tick < ticks; ++tick) {
        sensor->sense(tick, values);
        for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
      }
      for (const double sum : sums) samples.readings.push_back(sum / static_cast<double>(ticks));
    }
  return samples;
}

}  // namespace cohort::sensing
