#include "server/parsing/world/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "server/core/infinity.hpp"
#include "server/core/plane_vectors.hpp"
#include "server/core/random.hpp"

namespace cohort::parsing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t most_tries = 2000;

// Things that touch by less than this in height stand beside or on each other [m].
constexpr double touching = 1e-3;

// Places that are given may leave exactly the gap that is asked for [m].
constexpr double rounding = 1e-12;

// No draw from a normal distribution is further from its mean (RandomStream::normal).
constexpr double most_deviations = 7.0;

struct Bounds {
  double radius = 0.0;   // of the circle about a model's origin that holds it whatever its heading [m]
  double lowest = 0.0;   // z of what stands on the ground
  double highest = 0.0;  // z
};

Bounds bounds_of(const Model& model) {
  Bounds bounds{0.0, infinity, -infinity};
  for (const geometry::Footprint& part : geometry::footprints_of(model, Pose{})) {
    bounds.radius = std::max(bounds.radius, part.centre.norm() + part.half.norm() + part.radius);
    bounds.lowest = std::min(bounds.lowest, part.lowest);
    bounds.highest = std::max(bounds.highest, part.highest);
  }
  for (const Device& device : model.devices)
    if (const auto* const drive = std::get_if<TreelDrive>(&device))
      bounds.lowest = std::min(bounds.lowest, model.links[drive->link].X_ML.position.z() + drive->ground_height);
  if (!std::isfinite(bounds.lowest)) bounds.lowest = 0.0;
  bounds.highest = std::max(bounds.highest, bounds.lowest);
  return bounds;
}

struct Region {
  Vector2d lower;
  Vector2d upper;
};

Region region_around(const std::vector<Vector3d>& places) {
  if (places.empty()) return {Vector2d::Zero(), Vector2d::Zero()};
  Region region{places[0].head<2>(), places[0].head<2>()};
  for (const Vector3d& place : places) {
    region.lower = region.lower.cwiseMin(place.head<2>());
    region.upper = region.upper.cwiseMax(place.head<2>());
  }
  return region;
}

double direction_of(const Vector2d& vector) { return std::atan2(vector.y(), vector.x()); }

// What stands in the way of an instance, and the ground under it.
class Ground {
 public:
  Ground(const Placement& placement, const Bounds& bounds, const Occupancy& occupancy, const Region& region)
      : occupancy_(occupancy),
        bounds_(bounds),
        clearance_(bounds.radius + placement.gap),
        level_(placement.level),
        cells_(region.lower, region.upper, clearance_, occupancy.things().size() + placement.count) {
    for (const Occupancy::Thing& thing : occupancy.things()) cells_.add(thing);
  }

  /// Where the ground is under an instance at a point; nothing if it has no room there.
  std::optional<double> find(const Vector2d& point) const {
    if (!point.allFinite()) return std::nullopt;
    const double ground = highest_under(point);
    return is_free(point, ground) ? std::optional(ground) : std::nullopt;
  }

  void occupy(const Vector2d& point) {
    Occupancy::Thing circle;
    circle.footprint.centre = point;
    circle.footprint.radius = bounds_.radius;
    circle.footprint.lowest = -std::numeric_limits<double>::infinity();
    circle.footprint.highest = std::numeric_limits<double>::infinity();
    cells_.add(circle);
  }

 private:
  double highest_under(const Vector2d& point) const {
    std::optional<double> highest = occupancy_.terrain(point, bounds_.radius);
    const auto take = [&](double z) { highest = std::max(highest.value_or(z), z); };
    cells_.for_each_around(point, [&](const Occupancy::Thing& thing) {
      if (!thing.is_static || thing.footprint.highest > level_ + touching) return;
      if (thing.mesh == 0) {
        if (thing.footprint.distance(point) < bounds_.radius) take(thing.footprint.highest);
      } else if (const auto z = highest_on_disc(thing.triangle, point, bounds_.radius)) {
        take(*z);
      }
    });
    return highest.value_or(level_);
  }

  bool is_free(const Vector2d& point, double ground) const {
    const double lowest = ground + touching;
    const double highest = ground + bounds_.highest - bounds_.lowest - touching;
    bool is_free = true;
    std::map<std::uint32_t, int> surfaces_above;  // of meshes that enclose something
    cells_.for_each_around(point, [&](const Occupancy::Thing& thing) {
      if (!is_free || thing.footprint.highest <= lowest) return;
      if (thing.mesh != 0 && occupancy_.mesh(thing.mesh).is_closed && is_above(thing.triangle, point, ground))
        ++surfaces_above[thing.mesh];
      if (thing.footprint.lowest >= highest || thing.footprint.distance(point) >= clearance_ - rounding) return;
      is_free =
          thing.mesh != 0 && distance_between_heights(thing.triangle, lowest, highest, point) >= clearance_ - rounding;
    });
    const auto is_inside = [](const auto& mesh) { return mesh.second % 2 != 0; };
    return is_free && std::none_of(surfaces_above.begin(), surfaces_above.end(), is_inside);
  }

  // Of the triangles that share an edge one has the points on it, so that a line up through a surface counts it once.
  static bool is_above(const Triangle& t, const Vector2d& point, double z) {
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

  const Occupancy& occupancy_;
  Bounds bounds_;
  double clearance_;
  double level_;
  OccupancyCells cells_;
};

class Placer {
 public:
  Placer(const Placement& placement, const Model& model, const Occupancy& occupancy)
      : placement_(placement),
        bounds_(bounds_of(model)),
        occupancy_(occupancy),
        random_(placement.seed, placement.name, "placement") {}

  std::vector<Placed> place() {
    return std::visit([this](const auto& layout) { return place(layout); }, placement_.layout);
  }

 private:
  std::vector<Placed> place(const UniformLayout& layout) const {
    return draw({layout.lower, layout.upper}, [&](std::uint64_t instance, std::uint32_t first) -> Vector2d {
      const auto draw = [&](std::uint32_t which) { return random_.uniform(instance, first + which); };
      return layout.lower + (layout.upper - layout.lower).cwiseProduct(Vector2d(draw(0), draw(1)));
    });
  }
  std::vector<Placed> place(const GaussianLayout& layout) const {
    const Vector2d reach = Vector2d::Constant(most_deviations * layout.deviation);
    return draw({layout.centre - reach, layout.centre + reach},
                [&](std::uint64_t instance, std::uint32_t first) -> Vector2d {
                  const auto draw = [&](std::uint32_t which) { return random_.normal(instance, first + which); };
                  return layout.centre + layout.deviation * Vector2d(draw(0), draw(1));
                });
  }
  std::vector<Placed> place(const GridLayout& layout) const {
    const std::uint64_t columns = std::min(layout.columns, placement_.count);
    const std::uint64_t rows = (placement_.count + columns - 1) / columns;
    const auto half = [](std::uint64_t count) { return 0.5 * static_cast<double>(count - 1); };
    const Vector2d x_axis(std::cos(layout.yaw), std::sin(layout.yaw));
    const Vector2d y_axis = left_of(x_axis);
    std::vector<Vector3d> places;
    for (std::uint64_t i = 0; i < placement_.count; ++i) {
      const double column = static_cast<double>(i % columns) - half(columns);
      const std::uint64_t rows_before = i / columns;
      const double row = static_cast<double>(rows_before) - half(rows);
      const Vector2d point = layout.centre + layout.spacing * (column * x_axis + row * y_axis);
      places.emplace_back(point.x(), point.y(), heading(i, 0, point, 0.0));
    }
    return take(places);
  }
  std::vector<Placed> place(const RingLayout& layout) const {
    std::vector<Vector3d> places;
    for (std::uint64_t i = 0; i < placement_.count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(placement_.count);
      const double bearing = layout.first_bearing + 2.0 * std::numbers::pi * share;
      const Vector2d point = layout.centre + layout.radius * Vector2d(std::cos(bearing), std::sin(bearing));
      places.emplace_back(point.x(), point.y(), heading(i, 0, point, bearing + 0.5 * std::numbers::pi));
    }
    return take(places);
  }
  std::vector<Placed> place(const LineLayout& layout) const {
    std::vector<Vector3d> places;
    for (std::uint64_t i = 0; i < placement_.count; ++i) {
      const double share = i == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(placement_.count - 1);
      const Vector2d point = layout.from + share * (layout.to - layout.from);
      places.emplace_back(point.x(), point.y(), heading(i, 0, point, direction_of(layout.to - layout.from)));
    }
    return take(places);
  }
  std::vector<Placed> place(const FormationLayout& layout) const {
    const double turn = heading(0, 0, layout.centre, 0.0);
    const Vector2d x_axis(std::cos(turn), std::sin(turn));
    const Vector2d y_axis = left_of(x_axis);
    std::vector<Vector3d> places;
    for (const Vector3d& member : layout.members) {
      const Vector2d point = layout.centre + member.x() * x_axis + member.y() * y_axis;
      places.emplace_back(point.x(), point.y(), turn + member.z());
    }
    return take(places);
  }

  // `along`: where the ring or the line goes at the point.
  double heading(std::uint64_t instance, std::uint32_t first_draw, const Vector2d& point, double along) const {
    switch (placement_.heading) {
      case HeadingKind::random:
        return placement_.yaw + 2.0 * std::numbers::pi * (random_.uniform(instance, first_draw + 2) - 0.5);
      case HeadingKind::fixed: return placement_.yaw;
      case HeadingKind::towards: return placement_.yaw + direction_of(placement_.point - point);
      case HeadingKind::away: return placement_.yaw + direction_of(point - placement_.point);
      case HeadingKind::along: return placement_.yaw + along;
    }
    return 0.0;
  }

  Placed placed(std::uint64_t number, const Vector2d& point, double ground, double heading) const {
    const double half = 0.5 * heading;
    return {number, {{point.x(), point.y(), ground - bounds_.lowest}, {std::cos(half), 0.0, 0.0, std::sin(half)}}};
  }

  // Rejection sampling. `point_of`: the candidate of an instance whose draws begin at a number.
  template <class PointOf>
  std::vector<Placed> draw(const Region& region, const PointOf& point_of) const {
    Ground ground(placement_, bounds_, occupancy_, region);
    std::vector<Placed> instances;
    for (std::uint64_t instance = 0; instance < placement_.count; ++instance) {
      std::optional<double> z;
      for (std::uint32_t attempt = 0; attempt < most_tries && !z; ++attempt) {
        const Vector2d point = point_of(instance, 3 * attempt);
        z = ground.find(point);
        if (!z) continue;
        ground.occupy(point);
        instances.push_back(placed(instance, point, *z, heading(instance, 3 * attempt, point, 0.0)));
      }
      if (!z) break;
    }
    return instances;
  }

  // `places`: x, y and heading.
  std::vector<Placed> take(const std::vector<Vector3d>& places) const {
    Ground ground(placement_, bounds_, occupancy_, region_around(places));
    std::vector<Placed> instances;
    for (std::uint64_t number = 0; number < std::min<std::uint64_t>(placement_.count, places.size()); ++number) {
      const Vector2d point = places[number].head<2>();
      const std::optional<double> z = ground.find(point);
      if (!z) continue;
      ground.occupy(point);
      instances.push_back(placed(number, point, *z, places[number].z()));
    }
    return instances;
  }

  const Placement& placement_;
  Bounds bounds_;
  const Occupancy& occupancy_;
  RandomStream random_;
};

}  // namespace

std::vector<Placed> place_instances(const Placement& placement, const Model& model, const Occupancy& occupancy) {
  return Placer(placement, model, occupancy).place();
}

}  // namespace cohort::parsing
