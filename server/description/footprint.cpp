#include "server/description/footprint.hpp"

#include <cmath>

namespace cohort::description {
namespace {

// Below this a direction in the plane is rounding.
constexpr double negligible = 1e-9;

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

  std::optional<Footprint> operator()(const Box& box) const {
    const Eigen::Matrix3d R = X_WC.orientation.toRotationMatrix();
    const Eigen::Vector3d half = 0.5 * box.size;
    // The edge of the box that lies flattest gives the direction of the rectangle.
    Eigen::Vector2d axis = R.col(0).head<2>();
    if (axis.norm() < R.col(1).head<2>().norm() - negligible) axis = R.col(1).head<2>();
    Footprint footprint = on_axis(axis.normalized());
    const Eigen::Vector2d across(-footprint.axis.y(), footprint.axis.x());
    footprint.half = {(footprint.axis.transpose() * R.topRows<2>()).cwiseAbs().dot(half),
                      (across.transpose() * R.topRows<2>()).cwiseAbs().dot(half)};
    set_height(footprint, X_WC.position.z(), R.row(2).cwiseAbs().dot(half));
    return footprint;
  }

  std::optional<Footprint> operator()(const Sphere& sphere) const {
    Footprint footprint = on_axis(Eigen::Vector2d::UnitX());
    footprint.radius = sphere.radius;
    set_height(footprint, X_WC.position.z(), sphere.radius);
    return footprint;
  }

  std::optional<Footprint> operator()(const Cylinder& cylinder) const {
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

  std::optional<Footprint> operator()(const Plane&) const { return std::nullopt; }
};

}  // namespace

double Footprint::distance(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d offset = point - centre;
  const Eigen::Vector2d across(-axis.y(), axis.x());
  const Eigen::Vector2d in_axes(std::abs(axis.dot(offset)), std::abs(across.dot(offset)));
  return std::max(0.0, (in_axes - half).cwiseMax(0.0).norm() - radius);
}

Eigen::Vector2d Footprint::half_extent() const {
  const Eigen::Vector2d along = axis.cwiseAbs();
  return Eigen::Vector2d(along.x() * half.x() + along.y() * half.y(), along.y() * half.x() + along.x() * half.y()) +
         Eigen::Vector2d::Constant(radius);
}

std::optional<Footprint> footprint_of(const Shape& shape, const Pose& X_WC) { return std::visit(Shadow{X_WC}, shape); }

std::vector<Footprint> footprints_of(const Model& model, const Pose& X_WM) {
  std::vector<Footprint> footprints;
  for (const Link& link : model.links)
    for (const Collision& collision : link.collisions)
      if (const auto footprint = footprint_of(collision.shape, X_WM * link.X_ML * collision.X_LC))
        footprints.push_back(*footprint);
  return footprints;
}

}  // namespace cohort::description
