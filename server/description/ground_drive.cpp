// SPDX-License-Identifier: Apache-2.0
#include "server/description/ground_drive.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace cohort::description {
namespace {

constexpr double usual_limit = 1.0;        // [m/s] or [rad/s]
constexpr double least_cosine = 0.95;      // between axes that count as parallel, for camber and toe
constexpr double greatest_tilt = 0.3;      // z component of a horizontal axis, likewise
constexpr double reach_below = 0.5;        // fraction of its radius by which a wheel may end above the lowest one
constexpr double width_of_middle = 0.2;    // fraction of the half gauge
constexpr double least_half_gauge = 1e-6;  // [m]

double limited(double limit) { return std::isfinite(limit) ? limit : usual_limit; }

// Points of a shape in C, and the distance by which the shape extends around them.
struct Extent {
  std::vector<Eigen::Vector3d> points;
  double margin = 0.0;
};

Extent extent_of(const Box& box) {
  Extent extent;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) extent.points.push_back(box.size.cwiseProduct(Eigen::Vector3d(x, y, z)));
  return extent;
}
Extent extent_of(const Sphere& sphere) { return {{Eigen::Vector3d::Zero()}, sphere.radius}; }
Extent extent_of(const Ellipsoid& ellipsoid) { return {{Eigen::Vector3d::Zero()}, ellipsoid.radii.maxCoeff()}; }
Extent extent_of_rod(double radius, double length) {
  return {{{0.0, 0.0, -0.5 * length}, {0.0, 0.0, 0.5 * length}}, radius};
}
Extent extent_of(const Cylinder& cylinder) { return extent_of_rod(cylinder.radius, cylinder.length); }
Extent extent_of(const Capsule& capsule) { return extent_of_rod(capsule.radius, capsule.length); }
Extent extent_of(const Mesh& mesh) {
  if (!mesh.triangles) return {};
  return {mesh.triangles->vertices, 0.0};
}
template <class Ground>
Extent extent_of(const Ground&) {
  return {};
}

// A wheel or a belt. Vectors in M.
struct Roller {
  std::string channel;
  Eigen::Vector3d axis;
  Eigen::Vector3d centre;
  double radius = 1.0;  // value * radius = speed over the ground [m/s]
  double limit = 0.0;   // maximum value of the command
  double bottom = 0.0;  // height of its lowest point [m]
};

class DriveFinder {
 public:
  explicit DriveFinder(const Model& model) : model_(model) {}

  void operator()(const DifferentialDrive& drive) { take_twist(drive); }
  void operator()(const AckermannDrive& drive) { take_twist(drive); }
  void operator()(const TrackedDrive& drive) { take_twist(drive); }
  void operator()(const TreelDrive& drive) {
    if (!tracks_.empty()) return;
    const double speed = limited(drive.max_velocity);
    tracks_ = {{drive.name + "/left/velocity", speed, -speed}, {drive.name + "/right/velocity", speed, speed}};
  }
  void operator()(const Belt& belt) {
    const Link& link = model_.links[belt.link];
    const Eigen::AlignedBox3d box = box_of(link);
    if (box.isEmpty()) return;
    rollers_.push_back({belt.name + "/0/velocity", link.X_ML.orientation * belt.axis_L.normalized(), box.center(), 1.0,
                        belt.max_velocity, box.min().z()});
  }
  void operator()(const VelocityMotor& motor) {
    const Joint& joint = model_.joints[motor.joint];
    if (joint.type != JointType::revolute || std::isfinite(joint.axis.lower) || std::isfinite(joint.axis.upper)) return;
    const Link& wheel = model_.links[joint.child];
    const Pose X_MJ = wheel.X_ML * joint.X_LJ;
    const Eigen::Vector3d axis = X_MJ.orientation * joint.axis.direction;
    const double radius = radius_of(wheel, X_MJ.position, axis);
    if (radius <= 0.0) return;
    rollers_.push_back({motor.name + "/0/velocity", axis, box_of(wheel).center(), radius, motor.max_velocity,
                        X_MJ.position.z() - radius});
  }
  template <class Other>
  void operator()(const Other&) {}

  std::vector<DriveChannel> take() {
    if (!twist_.empty()) return twist_;
    if (!tracks_.empty()) return tracks_;
    return sides();
  }

 private:
  template <class Drive>
  void take_twist(const Drive& drive) {
    if (!twist_.empty()) return;
    twist_ = {{drive.name + "/0/linear", limited(drive.max_linear), 0.0},
              {drive.name + "/0/angular", 0.0, limited(drive.max_angular)}};
  }

  // Calls `use` with each point of the collisions of a link, in M, and its margin.
  template <class Use>
  static void for_points(const Link& link, const Use& use) {
    for (const Collision& collision : link.collisions) {
      const Pose X_MC = link.X_ML * collision.X_LC;
      const Extent extent = std::visit([](const auto& shape) { return extent_of(shape); }, collision.shape);
      for (const Eigen::Vector3d& point : extent.points) use(X_MC * point, extent.margin);
    }
  }

  static Eigen::AlignedBox3d box_of(const Link& link) {
    Eigen::AlignedBox3d box;
    for_points(link, [&](const Eigen::Vector3d& point, double margin) {
      box.extend(point - Eigen::Vector3d::Constant(margin));
      box.extend(point + Eigen::Vector3d::Constant(margin));
    });
    return box;
  }

  // Returns how far a link reaches from an axis.
  static double radius_of(const Link& link, const Eigen::Vector3d& on_axis, const Eigen::Vector3d& axis) {
    double radius = 0.0;
    for_points(link, [&](const Eigen::Vector3d& point, double margin) {
      radius = std::max(radius, (point - on_axis).cross(axis).norm() + margin);
    });
    return radius;
  }

  std::vector<DriveChannel> sides() {
    std::erase_if(rollers_, [](const Roller& each) { return std::abs(each.axis.z()) > greatest_tilt; });
    double lowest = std::numeric_limits<double>::infinity();
    for (const Roller& each : rollers_) lowest = std::min(lowest, each.bottom);
    std::erase_if(rollers_, [&](const Roller& each) { return each.bottom > lowest + reach_below * each.radius; });
    if (rollers_.size() < 2) return {};

    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d left = Eigen::Vector3d(rollers_[0].axis.x(), rollers_[0].axis.y(), 0.0).normalized();
    const Eigen::Vector3d forward = left.cross(up);
    const bool is_along_y = std::abs(forward.x()) <= greatest_tilt;
    if ((is_along_y ? forward.y() : forward.x()) < 0.0) left = -left;

    Eigen::AlignedBox1d gauge;
    double speed = std::numeric_limits<double>::infinity();
    for (const Roller& each : rollers_) {
      if (std::abs(each.axis.dot(left)) < least_cosine) return {};
      gauge.extend(Eigen::Matrix<double, 1, 1>(each.centre.dot(left)));
      speed = std::min(speed, each.limit * each.radius);
    }
    const double half_gauge = 0.5 * gauge.sizes()[0];
    if (half_gauge < least_half_gauge) return {};
    speed = limited(speed);

    std::vector<DriveChannel> channels;
    for (const Roller& each : rollers_) {
      const double aside = (each.centre.dot(left) - gauge.center()[0]) / half_gauge;
      const double side = std::abs(aside) < width_of_middle ? 0.0 : std::copysign(1.0, aside);
      const double value = std::copysign(speed / each.radius, each.axis.dot(left));
      channels.push_back({each.channel, value, side == 0.0 ? 0.0 : -side * value});
    }
    return channels;
  }

  const Model& model_;
  std::vector<DriveChannel> twist_;
  std::vector<DriveChannel> tracks_;
  std::vector<Roller> rollers_;
};

}  // namespace

std::vector<DriveChannel> ground_drive(const Model& model) {
  if (model.is_static) return {};
  DriveFinder finder(model);
  for (const Device& device : model.devices) std::visit(finder, device);
  return finder.take();
}

}  // namespace cohort::description
