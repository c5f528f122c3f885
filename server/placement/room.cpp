// SPDX-License-Identifier: Apache-2.0
#include "server/placement/room.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "server/core/infinity.hpp"

namespace cohort::placement {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Objects that overlap by less than this in height are beside or on top of each other [m].
constexpr double touching = 1e-3;

// Tolerance for listed positions that leave exactly the required gap [m].
constexpr double rounding = 1e-12;

// Points on an edge belong to only one of the triangles that share it, so a vertical line through a surface counts it
// once.
bool is_above(const Triangle& t, const Vector2d& point, double z) {
  bool inside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& a = t[i];
    const Vector3d& b = t[(i + 1) % 3];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  if (!inside) return false;
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  return normal.z() != 0.0 && t[0].z() - normal.head<2>().dot(point - t[0].head<2>()) / normal.z() > z + touching;
}

std::optional<double> higher(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(std::max(*a, *b)) : a ? a : b;
}

}  // namespace

Extent extent_of(const Model& model) {
  Extent extent{0.0, infinity, -infinity};
  for (const geometry::Footprint& part : geometry::footprints_of(model, Pose{})) {
    extent.radius = std::max(extent.radius, part.centre.norm() + part.half.norm() + part.radius);
    extent.lowest = std::min(extent.lowest, part.lowest);
    extent.highest = std::max(extent.highest, part.highest);
  }
  for (const Device& device : model.devices)
    if (const auto tracks = tracks_of(device))
      extent.lowest = std::min(extent.lowest, model.links[tracks->link].X_ML.position.z() + tracks->ground_height);
  if (!std::isfinite(extent.lowest)) extent.lowest = 0.0;
  extent.highest = std::max(extent.highest, extent.lowest);
  return extent;
}

StaticRoom::StaticRoom(const Population& population, const Extent& extent, const Occupancy& fixed, std::size_t moving)
    : fixed_(fixed),
      extent_(extent),
      clearance_(extent.radius + population.gap),
      level_(population.level),
      cells_([&] {
        const Region region = region_of(population);
        return Cells(region.lower, region.upper, clearance_, fixed.things().size() + moving + population.count);
      }()),
      things_(cells_) {
  for (const Occupancy::Thing& thing : fixed.things()) things_.add(thing, cells_);
}

Room::Room(const StaticRoom& room, const Occupancy& earlier, std::size_t count)
    : room_(room), earlier_(earlier), things_(room.cells_) {
  for (const Occupancy::Thing& thing : earlier.things()) things_.add(thing, room.cells_);
  circles_.reserve(count);
}

std::optional<double> Room::find(const Vector2d& point) const {
  if (!point.allFinite()) return std::nullopt;
  const std::size_t cell = room_.cells_.cell_of(point);
  const double ground = highest_under(point, cell);
  return is_free(point, cell, ground) ? std::optional(ground) : std::nullopt;
}

void Room::occupy(const Vector2d& point) {
  Occupancy::Thing& circle = circles_.emplace_back();
  circle.footprint.centre = point;
  circle.footprint.radius = room_.extent_.radius;
  circle.footprint.lowest = -infinity;
  circle.footprint.highest = infinity;
  things_.add(circle, room_.cells_);
}

double Room::highest_under(const Vector2d& point, std::size_t cell) const {
  const double radius = room_.extent_.radius;
  std::optional<double> highest = higher(room_.fixed_.terrain(point, radius), earlier_.terrain(point, radius));
  for_each_in(cell, [&](const Occupancy::Thing& thing) {
    if (!thing.is_static || thing.footprint.highest > room_.level_ + touching) return true;
    if (thing.mesh != 0)
      highest = higher(highest, highest_on_disc(thing.triangle, point, radius));
    else if (thing.footprint.distance(point) < radius)
      highest = higher(highest, thing.footprint.highest);
    return true;
  });
  return highest.value_or(room_.level_);
}

bool Room::is_free(const Vector2d& point, std::size_t cell, double ground) const {
  const double lowest = ground + touching;
  const double highest = ground + room_.extent_.highest - room_.extent_.lowest - touching;
  const double clearance = room_.clearance_ - rounding;
  std::map<std::uint32_t, int> surfaces_above;  // meshes that enclose a volume
  const bool is_free = for_each_in(cell, [&](const Occupancy::Thing& thing) {
    if (thing.footprint.highest <= lowest) return true;
    if (thing.is_closed && is_above(thing.triangle, point, ground)) ++surfaces_above[thing.mesh];
    if (thing.footprint.lowest >= highest || thing.footprint.distance(point) >= clearance) return true;
    return thing.mesh != 0 && distance_between_heights(thing.triangle, lowest, highest, point) >= clearance;
  });
  return is_free && std::ranges::none_of(surfaces_above, [](const auto& mesh) { return mesh.second % 2 != 0; });
}

}  // namespace cohort::placement
