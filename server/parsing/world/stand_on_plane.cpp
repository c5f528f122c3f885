// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/stand_on_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "server/geometry/shapes/shapes.hpp"

namespace cohort::parsing {
namespace {

constexpr double gap_above_plane = 1e-3;  // [m]

// Returns infinity if nothing is solid, and minus infinity if something is ground.
double lowest_point(const World& world) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Instance& instance : world.instances)
    for (const Link& link : world.models[instance.model].links)
      for (const Collision& collision : link.collisions) {
        const Pose X_WC = instance.X_WM * link.X_ML * collision.X_LC;
        lowest = std::min(lowest, geometry::bounds_of(collision.shape, X_WC).lower.z());
      }
  return lowest;
}

Model plane_to_stand_on(const World& world) {
  Model ground;
  ground.name = "ground";
  const auto is_taken = [&](const Instance& instance) { return instance.name == ground.name; };
  while (std::ranges::any_of(world.instances, is_taken)) ground.name += "_";
  ground.is_static = true;
  Link& link = ground.links.emplace_back();
  link.name = "link";
  link.collisions.push_back({"collision", {}, description::Plane{}, {}});
  return ground;
}

void warn_of_what_falls(World& world) {
  for (const Instance& instance : world.instances)
    if (world.models[instance.model].why_fixed() == nullptr)
      world.warnings.push_back(
          {world.file, 0, "model[" + instance.name + "]", "has no collisions, so it falls through the ground"});
}

}  // namespace

void stand_on_plane(World& world) {
  const double lowest = lowest_point(world);
  if (lowest == std::numeric_limits<double>::infinity()) return warn_of_what_falls(world);
  if (!std::isfinite(lowest)) return;
  for (Instance& instance : world.instances) instance.X_WM.position.z() += gap_above_plane - lowest;
  Model ground = plane_to_stand_on(world);
  const std::string name = ground.name;
  world.models.push_back(std::move(ground));
  world.instances.push_back({name, world.models.size() - 1, {}});
}

}  // namespace cohort::parsing
