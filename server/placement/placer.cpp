// SPDX-License-Identifier: Apache-2.0
#include "server/placement/placer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "server/core/random.hpp"
#include "server/placement/layouts.hpp"
#include "server/placement/occupancy.hpp"
#include "server/placement/room.hpp"

namespace cohort::placement {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t most_tries = 2000;

// Returns a copy of the model with only the collisions that can be obstacles.
Model solid_part(const Model& model) {
  Model solid;
  solid.is_static = model.is_static;
  for (const Link& link : model.links) solid.links.push_back({"", link.X_ML, {}, link.collisions});
  return solid;
}

std::size_t count_of_collisions(const std::vector<Model>& bodies) {
  std::size_t count = 0;
  for (const Model& body : bodies)
    for (const Link& link : body.links) count += link.collisions.size();
  return count;
}

}  // namespace

struct Placer::Prepared {
  struct PreparedPopulation {
    Population population;
    Extent extent;
    std::vector<Model> bodies;  // with nothing but their collisions, which are in the way of later populations
    StaticRoom room;
  };

  explicit Prepared(const World& world);
  std::vector<Placed> draw(const PreparedPopulation& prepared, std::uint64_t seed, const Occupancy& earlier) const;

  Occupancy fixed;
  std::vector<PreparedPopulation> populations;
};

Placer::Prepared::Prepared(const World& world) {
  if (world.populations.empty()) return;
  for (std::size_t i = 0; i < world.populations.front().first; ++i)
    fixed.add(world.models[world.instances[i].model], world.instances[i].X_WM);
  std::size_t moving = 0;
  for (const Population& population : world.populations) {
    const Extent extent = extent_of(world.models[population.model]);
    std::vector<Model> bodies;
    for (std::size_t body = 0; body < population.bodies; ++body)
      bodies.push_back(solid_part(world.models[population.model + body]));
    StaticRoom room(population, extent, fixed, moving);
    moving += population.count * count_of_collisions(bodies);
    populations.push_back({population, extent, std::move(bodies), std::move(room)});
  }
}

std::vector<Placed> Placer::Prepared::draw(const PreparedPopulation& prepared, std::uint64_t seed,
                                           const Occupancy& earlier) const {
  const Population& population = prepared.population;
  const RandomStream random(seed + population.seed_offset, population.name, "placement");
  Room room(prepared.room, earlier, population.count);
  std::vector<Placed> places;
  // Places an instance at the point; returns false if there is no room.
  const auto try_at = [&](std::uint64_t number, const Vector2d& point, const auto& heading_of) {
    const std::optional<double> ground = room.find(point);
    if (!ground) return false;
    room.occupy(point);
    const double half = 0.5 * heading_of();
    places.push_back(
        {number,
         {{point.x(), point.y(), *ground - prepared.extent.lowest}, {std::cos(half), 0.0, 0.0, std::sin(half)}}});
    return true;
  };
  if (!is_drawn(population.layout)) {
    const std::vector<Vector3d> given = given_places(population, random);
    for (std::size_t i = 0; i < given.size(); ++i) try_at(i, given[i].head<2>(), [&] { return given[i].z(); });
    return places;
  }
  // Rejection sampling, until an instance cannot be placed.
  for (std::uint64_t instance = 0; instance < population.count && places.size() == instance; ++instance)
    for (std::uint32_t attempt = 0; attempt < most_tries; ++attempt) {
      const Vector2d point = drawn_point(population.layout, random, instance, attempt);
      if (try_at(instance, point, [&] { return drawn_heading(population, random, instance, attempt, point); })) break;
    }
  return places;
}

std::string how_many_fit(std::size_t placed, std::uint64_t count) {
  return "only " + std::to_string(placed) + " of " + std::to_string(count) + " fit";
}

Placer::Placer(const World& world) : prepared_(std::make_unique<const Prepared>(world)) {
  if (world.populations.empty()) return;
  first_ = world.populations.front().first;
  for (const Population& population : world.populations) count_ += population.numbers.size() * population.bodies;
}
Placer::Placer(Placer&& other) noexcept = default;
Placer& Placer::operator=(Placer&& other) noexcept = default;
Placer::~Placer() = default;

std::vector<std::vector<Placed>> Placer::draw(std::uint64_t seed, std::vector<Problem>& problems) const {
  std::vector<std::vector<Placed>> drawn;
  Occupancy earlier(prepared_->fixed.next_mesh());
  for (const Prepared::PreparedPopulation& prepared : prepared_->populations) {
    const Population& population = prepared.population;
    const std::vector<Placed>& places = drawn.emplace_back(prepared_->draw(prepared, seed, earlier));
    if (places.size() < population.count && !population.may_be_fewer) {
      Problem& problem = problems.emplace_back(population.placement_place);
      problem.message = how_many_fit(places.size(), population.count) +
                        "; enlarge the area, or lower the count or the gap, or set <cohort:may_be_fewer>";
      break;
    }
    if (&prepared == &prepared_->populations.back()) break;
    for (const Placed& each : places)
      for (const Model& body : prepared.bodies) earlier.add(body, each.X_WM);
  }
  return drawn;
}

bool Placer::place(std::uint64_t seed, std::span<Pose> X_WM) const {
  std::vector<Problem> problems;
  const std::vector<std::vector<Placed>> drawn = draw(seed, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (!std::ranges::equal(drawn[i], prepared_->populations[i].population.numbers, {}, &Placed::number)) return false;
  std::size_t next = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (const Placed& each : drawn[i])
      for (std::size_t body = 0; body < prepared_->populations[i].bodies.size(); ++body) X_WM[next++] = each.X_WM;
  return true;
}

}  // namespace cohort::placement
