// SPDX-License-Identifier: Apache-2.0
#include "server/placement/layouts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

#include "server/core/plane_vectors.hpp"

namespace cohort::placement {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// No draw from a normal distribution is further from its mean (RandomStream::normal).
constexpr double most_deviations = 7.0;

// Number of draws of an attempt: x, y and heading.
constexpr std::uint32_t draws = 3;

// Covers the rounding errors of lengths that are computed in two ways.
constexpr double margin = 1.0 + 1e-9;

double direction_of(const Vector2d& vector) { return std::atan2(vector.y(), vector.x()); }

// `along`: direction of the ring or the line at the point.
double heading_at(const Population& population, const RandomStream& random, std::uint64_t instance,
                  std::uint32_t first_draw, const Vector2d& point, double along) {
  switch (population.heading) {
    case HeadingKind::random:
      return population.yaw + 2.0 * std::numbers::pi * (random.uniform(instance, first_draw + 2) - 0.5);
    case HeadingKind::fixed: return population.yaw;
    case HeadingKind::towards: return population.yaw + direction_of(population.point - point);
    case HeadingKind::away: return population.yaw + direction_of(point - population.point);
    case HeadingKind::along: return population.yaw + along;
  }
  return 0.0;
}

class GivenPlaces {
 public:
  GivenPlaces(const Population& population, const RandomStream& random) : population_(population), random_(random) {}

  std::vector<Vector3d> operator()(const GridLayout& layout) {
    const std::uint64_t columns =
        std::clamp<std::uint64_t>(population_.count, 1, std::max<std::uint64_t>(layout.columns, 1));
    const std::uint64_t rows = (population_.count + columns - 1) / columns;
    const auto half = [](std::uint64_t count) { return 0.5 * static_cast<double>(count - 1); };
    const Vector2d x_axis(std::cos(layout.yaw), std::sin(layout.yaw));
    const Vector2d y_axis = left_of(x_axis);
    for (std::uint64_t i = 0; i < population_.count; ++i) {
      const double column = static_cast<double>(i % columns) - half(columns);
      const std::uint64_t rows_before = i / columns;
      const double row = static_cast<double>(rows_before) - half(rows);
      add(layout.centre + layout.spacing * (column * x_axis + row * y_axis), 0.0);
    }
    return std::move(places_);
  }
  std::vector<Vector3d> operator()(const RingLayout& layout) {
    for (std::uint64_t i = 0; i < population_.count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(population_.count);
      const double bearing = layout.first_bearing + 2.0 * std::numbers::pi * share;
      add(layout.centre + layout.radius * Vector2d(std::cos(bearing), std::sin(bearing)),
          bearing + 0.5 * std::numbers::pi);
    }
    return std::move(places_);
  }
  std::vector<Vector3d> operator()(const LineLayout& layout) {
    for (std::uint64_t i = 0; i < population_.count; ++i) {
      const double share = i == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(population_.count - 1);
      add(layout.from + share * (layout.to - layout.from), direction_of(layout.to - layout.from));
    }
    return std::move(places_);
  }
  std::vector<Vector3d> operator()(const FormationLayout& layout) {
    const double turn = heading_at(population_, random_, 0, 0, layout.centre, 0.0);
    const Vector2d x_axis(std::cos(turn), std::sin(turn));
    const Vector2d y_axis = left_of(x_axis);
    for (const Vector3d& member : layout.members) {
      const Vector2d point = layout.centre + member.x() * x_axis + member.y() * y_axis;
      places_.emplace_back(point.x(), point.y(), turn + member.z());
    }
    if (places_.size() > population_.count) places_.resize(population_.count);
    return std::move(places_);
  }
  template <class Drawn>
  std::vector<Vector3d> operator()(const Drawn&) {
    throw std::logic_error("the layout has no positions");
  }

 private:
  void add(const Vector2d& point, double along) {
    const double heading = heading_at(population_, random_, places_.size(), 0, point, along);
    places_.emplace_back(point.x(), point.y(), heading);
  }

  const Population& population_;
  const RandomStream& random_;
  std::vector<Vector3d> places_;
};

Region region_around(const std::vector<Vector3d>& places) {
  if (places.empty()) return {};
  Region region{places[0].head<2>(), places[0].head<2>()};
  for (const Vector3d& place : places) {
    region.lower = region.lower.cwiseMin(place.head<2>());
    region.upper = region.upper.cwiseMax(place.head<2>());
  }
  return region;
}

Region region_around(const Vector2d& centre, double reach) {
  return {centre - Vector2d::Constant(reach), centre + Vector2d::Constant(reach)};
}

}  // namespace

bool is_drawn(const Layout& layout) {
  return std::holds_alternative<UniformLayout>(layout) || std::holds_alternative<GaussianLayout>(layout);
}

Vector2d drawn_point(const Layout& layout, const RandomStream& random, std::uint64_t instance, std::uint32_t attempt) {
  const std::uint32_t first = draws * attempt;
  if (const auto* const uniform = std::get_if<UniformLayout>(&layout)) {
    const Vector2d drawn(random.uniform(instance, first), random.uniform(instance, first + 1));
    return uniform->lower + (uniform->upper - uniform->lower).cwiseProduct(drawn);
  }
  const auto& gaussian = std::get<GaussianLayout>(layout);
  return gaussian.centre +
         gaussian.deviation * Vector2d(random.normal(instance, first), random.normal(instance, first + 1));
}

double drawn_heading(const Population& population, const RandomStream& random, std::uint64_t instance,
                     std::uint32_t attempt, const Vector2d& point) {
  return heading_at(population, random, instance, draws * attempt, point, 0.0);
}

std::vector<Vector3d> given_places(const Population& population, const RandomStream& random) {
  return std::visit(GivenPlaces(population, random), population.layout);
}

Region region_of(const Population& population) {
  const RandomStream any(0, "", "");  // the seed only turns given places, and formations
  const auto* const formation = std::get_if<FormationLayout>(&population.layout);
  if (formation != nullptr && population.heading == HeadingKind::random) {
    double farthest = 0.0;
    for (const Vector3d& member : formation->members) farthest = std::max(farthest, member.head<2>().norm());
    return region_around(formation->centre, margin * farthest);
  }
  if (const auto* const uniform = std::get_if<UniformLayout>(&population.layout))
    return {uniform->lower, uniform->upper};
  if (const auto* const gaussian = std::get_if<GaussianLayout>(&population.layout))
    return region_around(gaussian->centre, most_deviations * gaussian->deviation);
  return region_around(given_places(population, any));
}

}  // namespace cohort::placement
