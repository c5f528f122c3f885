#include "server/description/placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "server/core/random.hpp"

namespace cohort::description {
namespace {

constexpr std::uint32_t most_tries = 2000;

// Things that touch by less than this in height stand beside or on each other.
constexpr double touching = 1e-3;

// The circle about a model's origin that holds it whatever its heading, and how high it reaches.
struct Bounds {
  double radius = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
};

Bounds bounds_of(const Model& model) {
  Bounds bounds;
  for (const Footprint& part : footprints_of(model, Pose{})) {
    bounds.radius = std::max(bounds.radius, part.centre.norm() + part.half.norm() + part.radius);
    bounds.lowest = std::min(bounds.lowest, part.lowest);
    bounds.highest = std::max(bounds.highest, part.highest);
  }
  return bounds;
}

// What is in the way of the origin of an instance, in square cells over the rectangle.
class Occupied {
 public:
  // `things` is how many footprints will be added, more or less: it bounds the number of cells.
  Occupied(const UniformPlacement& placement, double clearance, std::size_t things)
      : lower_(placement.lower), upper_(placement.upper), clearance_(clearance) {
    const Eigen::Vector2d size = upper_ - lower_;
    cell_ = std::max({clearance, std::sqrt(size.prod() / static_cast<double>(things + 1)),
                      size.maxCoeff() / static_cast<double>(things + 1), negligible_cell});
    columns_ = 1 + static_cast<std::size_t>(size.x() / cell_);
    rows_ = 1 + static_cast<std::size_t>(size.y() / cell_);
    cells_.resize(columns_ * rows_);
  }

  void add(const Footprint& footprint) {
    const Eigen::Vector2d reach = footprint.half_extent() + Eigen::Vector2d::Constant(clearance_);
    const Eigen::Vector2d from = footprint.centre - reach;
    const Eigen::Vector2d to = footprint.centre + reach;
    if ((to.array() < lower_.array()).any() || (from.array() > upper_.array()).any()) return;
    for (std::size_t row = index(from.y() - lower_.y(), rows_); row <= index(to.y() - lower_.y(), rows_); ++row)
      for (std::size_t column = index(from.x() - lower_.x(), columns_); column <= index(to.x() - lower_.x(), columns_);
           ++column)
        cells_[row * columns_ + column].push_back(footprint);
  }

  bool is_free(const Eigen::Vector2d& point) const {
    const std::size_t cell = index(point.y() - lower_.y(), rows_) * columns_ + index(point.x() - lower_.x(), columns_);
    return std::none_of(cells_[cell].begin(), cells_[cell].end(),
                        [&](const Footprint& footprint) { return footprint.distance(point) < clearance_; });
  }

 private:
  static constexpr double negligible_cell = 1e-3;

  std::size_t index(double offset, std::size_t count) const {
    return static_cast<std::size_t>(std::clamp(offset / cell_, 0.0, static_cast<double>(count - 1)));
  }

  Eigen::Vector2d lower_;
  Eigen::Vector2d upper_;
  double clearance_;
  double cell_ = 1.0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::vector<Footprint>> cells_;  // row by row
};

}  // namespace

std::vector<Pose> place_uniformly(const UniformPlacement& placement, const Model& model,
                                  const std::vector<Footprint>& obstacles) {
  const Bounds bounds = bounds_of(model);
  Occupied occupied(placement, bounds.radius + placement.gap, obstacles.size() + placement.count);
  for (const Footprint& obstacle : obstacles)
    if (obstacle.highest > bounds.lowest + touching && obstacle.lowest < bounds.highest - touching)
      occupied.add(obstacle);

  const RandomStream random(placement.seed, placement.name, "placement");
  const auto draw_place = [&](std::uint64_t instance) -> std::optional<Pose> {
    for (std::uint32_t attempt = 0; attempt < most_tries; ++attempt) {
      const auto draw = [&](std::uint32_t which) { return random.uniform(instance, 3 * attempt + which); };
      const Eigen::Vector2d point =
          placement.lower + (placement.upper - placement.lower).cwiseProduct(Eigen::Vector2d(draw(0), draw(1)));
      if (!occupied.is_free(point)) continue;
      const double half_heading = std::numbers::pi * (draw(2) - 0.5);
      return Pose{{point.x(), point.y(), 0.0}, {std::cos(half_heading), 0.0, 0.0, std::sin(half_heading)}};
    }
    return std::nullopt;
  };

  std::vector<Pose> poses;
  Footprint circle;
  circle.radius = bounds.radius;
  for (std::uint64_t instance = 0; instance < placement.count; ++instance) {
    const std::optional<Pose> pose = draw_place(instance);
    if (!pose) break;
    circle.centre = pose->position.head<2>();
    occupied.add(circle);
    poses.push_back(*pose);
  }
  return poses;
}

}  // namespace cohort::description
