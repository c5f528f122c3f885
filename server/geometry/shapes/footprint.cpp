// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/core/plane_vectors.hpp"
#include "server/geometry/shapes/convex_hull_2d.hpp"

namespace cohort::geometry {
namespace {

// Components of a direction below this are rounding errors.
constexpr double negligible = 1e-9;

// Returns the rectangle of least area around points: it has an edge along one of their convex hull.
Footprint least_rectangle(const std::vector<Eigen::Vector2d>& points) {
  const std::vector<Eigen::Vector2d> hull = convex_hull_2d(points);
  Footprint least;
  double least_area = std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Eigen::Vector2d& axis) {
    const Eigen::Vector2d across = left_of(axis);
    Eigen::Vector2d lower = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d upper = -lower;
    for (const Eigen::Vector2d& corner : hull) {
      const Eigen::Vector2d in_axes(axis.dot(corner), across.dot(corner));
      lower = lower.cwiseMin(in_axes);
      upper = upper.cwiseMax(in_axes);
    }
    if (const double area = (upper - lower).prod(); area < least_area) {
      least_area = area;
      const Eigen::Vector2d middle = 0.5 * (lower + upper);
      least.centre = middle.x() * axis + middle.y() * across;
      least.axis = axis;
      least.half = 0.5 * (upper - lower);
    }
  };
  try_axis(Eigen::Vector2d::UnitX());
  for (std::size_t i = 0; i < hull.size(); ++i)
    if (const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i]; edge.norm() > negligible)
      try_axis(edge.normalized());
  return least;
}

struct Shadow {
  const Pose& X_WC;

  Footprint on_axis(const Eigen::Vector2d& axis) const {
    Footprint footprint;
    footprint.centre = X_WC.position.head<2>();
    footprint.axis = axis;
    return footprint;
  }

  static void set_height(Footprint& footprint, double middle, double half) {
    footprint.lowest = middle - half;
    footprint.highest = middle + half;
  }

  std::optional<Footprint> operator()(const description::Box& box) const {
    const Eigen::Matrix3d R = X_WC.orientation.toRotationMatrix();
    const Eigen::Vector3d half = 0.5 * box.size;
    // The most level edge of the box gives the direction of the rectangle.
    Eigen::Vector2d axis = R.col(0).head<2>();
    if (axis.norm() < R.col(1).head<2>().norm() - negligible) axis = R.col(1).head<2>();
    Footprint footprint = on_axis(axis.normalized());
    const Eigen::Vector2d across(-footprint.axis.y(), footprint.axis.x());
    footprint.half = {(footprint.axis.transpose() * R.topRows<2>()).cwiseAbs().dot(half),
                      (across.transpose() * R.topRows<2>()).cwiseAbs().dot(half)};
    set_height(footprint, X_WC.position.z(), R.row(2).cwiseAbs().dot(half));
    return footprint;
  }

  std::optional<Footprint> operator()(const description::Sphere& sphere) const {
    Footprint footprint = on_axis(Eigen::Vector2d::UnitX());
    footprint.radius = sphere.radius;
    set_height(footprint, X_WC.position.z(), sphere.radius);
    return footprint;
  }

  std::optional<Footprint> operator()(const description::Cylinder& cylinder) const {
    const Eigen::Vector3d along = X_WC.orientation * Eigen::Vector3d::UnitZ();
    const double lean = along.head<2>().norm();
    const double half_length = 0.5 * cylinder.length;
    Footprint footprint = on_axis(Eigen::Vector2d::UnitX());
    if (lean < negligible) {
      footprint.radius = cylinder.radius;
    } else {
      footprint.axis = along.head<2>() / lean;
      footprint.half = {half_length * lean + cylinder.radius * std::abs(along.z()), cylinder.radius};
    }
    set_height(footprint, X_WC.position.z(), half_length * std::abs(along.z()) + cylinder.radius * lean);
    return footprint;
  }

  std::optional<Footprint> operator()(const description::Capsule& capsule) const {
    const Eigen::Vector3d half_axis = X_WC.orientation * Eigen::Vector3d(0.0, 0.0, 0.5 * capsule.length);
    const double lean = half_axis.head<2>().norm();
    Footprint footprint = on_axis(Eigen::Vector2d::UnitX());
    if (lean >= negligible) footprint.axis = half_axis.head<2>() / lean;
    footprint.half.x() = lean;
    footprint.radius = capsule.radius;
    set_height(footprint, X_WC.position.z(), std::abs(half_axis.z()) + capsule.radius);
    return footprint;
  }

  // The projection is an ellipse. It lies within the rounded rectangle of the same length and width.
  std::optional<Footprint> operator()(const description::Ellipsoid& ellipsoid) const {
    const Eigen::Matrix3d axes = X_WC.orientation.toRotationMatrix() * ellipsoid.radii.asDiagonal();
    const Eigen::Matrix2d spread = axes.topRows<2>() * axes.topRows<2>().transpose();
    const double middle = 0.5 * (spread(0, 0) + spread(1, 1));
    const Eigen::Vector2d difference(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
    const double shortest = std::sqrt(std::max(0.0, middle - difference.norm()));
    const double longest = std::sqrt(middle + difference.norm());
    const double half_angle = 0.5 * std::atan2(difference.y(), difference.x());
    Footprint footprint = on_axis({std::cos(half_angle), std::sin(half_angle)});
    footprint.half.x() = longest - shortest;
    footprint.radius = shortest;
    set_height(footprint, X_WC.position.z(), axes.row(2).norm());
    return footprint;
  }

  std::optional<Footprint> operator()(const description::Mesh& mesh) const {
    std::vector<Eigen::Vector2d> points;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const Eigen::Vector3d& vertex : mesh.triangles->vertices) {
      const Eigen::Vector3d vertex_W = X_WC * vertex;
      points.emplace_back(vertex_W.head<2>());
      lowest = std::min(lowest, vertex_W.z());
      highest = std::max(highest, vertex_W.z());
    }
    if (points.empty()) return std::nullopt;
    Footprint footprint = least_rectangle(points);
    footprint.lowest = lowest;
    footprint.highest = highest;
    return footprint;
  }

  std::optional<Footprint> operator()(const description::Plane&) const { return std::nullopt; }
  std::optional<Footprint> operator()(const description::Heightmap&) const { return std::nullopt; }
};

}  // namespace

double Footprint::distance(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d offset = point - centre;
  const Eigen::Vector2d across = left_of(axis);
  const Eigen::Vector2d in_axes(std::abs(axis.dot(offset)), std::abs(across.dot(offset)));
  return std::max(0.0, (in_axes - half).cwiseMax(0.0).norm() - radius);
}

Eigen::Vector2d Footprint::half_extent() const {
  const Eigen::Vector2d along = axis.cwiseAbs();
  return Eigen::Vector2d(along.x() * half.x() + along.y() * half.y(), along.y() * half.x() + along.x() * half.y()) +
         Eigen::Vector2d::Constant(radius);
}

std::optional<Footprint> footprint_of(const description::Shape& shape, const Pose& X_WC) {
  return std::visit(Shadow{X_WC}, shape);
}

std::vector<Footprint> footprints_of(const description::Model& model, const Pose& X_WM) {
  std::vector<Footprint> footprints;
  for (const description::Link& link : model.links)
    for (const description::Collision& collision : link.collisions)
      if (const auto footprint = footprint_of(collision.shape, X_WM * link.X_ML * collision.X_LC))
        footprints.push_back(*footprint);
  return footprints;
}

}  // namespace cohort::geometry
