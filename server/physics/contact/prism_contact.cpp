// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/prism_contact.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double almost_parallel = 0.97;  // cosine of the greatest angle between the axes
constexpr double one_point = 1e-3;        // a common interval shorter than this gives one point [m]

// The interval in which a and b overlap along the axis.
struct Stretch {
  double low;
  double high;
  double length() const { return high - low; }
};

// A contact point of the cross-section at one height.
struct SectionContact {
  Vector3d surface_W;  // on b
  Vector3d normal_W;
  double gap;
};

// Adds the points once the section is known at both ends of the interval.
bool take_ends(const Stretch& stretch, const SectionContact& low, const SectionContact& high, double margin,
               ContactPoints& found) {
  // The overlap is deeper sideways than along the axis: one shape stands on the other.
  if (std::min(low.gap, high.gap) < -stretch.length()) return false;
  if (stretch.length() < one_point) {
    if (low.gap < margin) found.add(low.surface_W + 0.5 * low.gap * low.normal_W, low.normal_W, low.gap);
    return true;
  }
  for (const SectionContact* end : {&low, &high})
    if (end->gap < margin) found.add(end->surface_W + 0.5 * end->gap * end->normal_W, end->normal_W, end->gap);
  return true;
}

}  // namespace

bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Cylinder& b,
                       const Pose& X_WB, double margin, ContactPoints& found) {
  const Vector3d axis_a = X_WA.orientation * Vector3d::UnitZ();
  Vector3d axis_b = X_WB.orientation * Vector3d::UnitZ();
  double cosine = axis_a.dot(axis_b);
  if (cosine < 0.0) {
    axis_b = -axis_b;
    cosine = -cosine;
  }
  if (cosine < almost_parallel) return false;

  const Vector3d axis = (axis_a + axis_b).normalized();
  const double centre = axis.dot(X_WA.position - X_WB.position);  // position of a's centre relative to b's
  const Stretch stretch{std::max(centre - 0.5 * a.length, -0.5 * b.length),
                        std::min(centre + 0.5 * a.length, 0.5 * b.length)};
  const double rim_rise = std::max(a.radius, b.radius) * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (stretch.length() < -(margin + rim_rise)) return true;
  if (stretch.length() <= rim_rise) return false;

  const double along = axis.dot(axis_a);  // axis.dot(axis_b) is the same
  const auto section = [&](double height) {
    const Vector3d on_b = X_WB.position + height / along * axis_b;
    const Vector3d offset = X_WA.position + (height - centre) / along * axis_a - on_b;
    const Vector3d across = offset - axis.dot(offset) * axis;
    const double distance = across.norm();
    const Vector3d normal_W = distance > 0.0 ? Vector3d(across / distance) : Vector3d(axis.unitOrthogonal());
    return SectionContact{on_b + b.radius * normal_W, normal_W, distance - a.radius - b.radius};
  };
  return take_ends(stretch, section(stretch.low), section(stretch.high), margin, found);
}

bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Box& b, const Pose& X_WB,
                       double margin, ContactPoints& found) {
  const Pose X_BA = X_WB.inverse() * X_WA;
  Vector3d axis_a = X_BA.orientation * Vector3d::UnitZ();
  int up = 0;
  axis_a.cwiseAbs().maxCoeff(&up);
  if (axis_a[up] < 0.0) axis_a = -axis_a;
  const double cosine = axis_a[up];
  if (cosine < almost_parallel) return false;

  const Vector3d half = 0.5 * b.size;
  const double centre = X_BA.position[up];
  const Stretch stretch{std::max(centre - 0.5 * a.length, -half[up]), std::min(centre + 0.5 * a.length, half[up])};
  const double rim_rise = a.radius * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (stretch.length() < -(margin + rim_rise)) return true;
  if (stretch.length() <= rim_rise) return false;

  const Matrix3d R = X_WB.orientation.toRotationMatrix();
  const auto section = [&](double height) {
    Vector3d point = X_BA.position + (height - centre) / cosine * axis_a;
    point[up] = height;
    Vector3d nearest = point.cwiseMax(-half).cwiseMin(half);
    nearest[up] = height;
    Vector3d normal = point - nearest;
    double distance = normal.norm();
    if (distance > 0.0) {
      normal /= distance;
    } else {  // the cylinder's axis is inside the box: use the nearest side
      Vector3d depth = half - point.cwiseAbs();
      depth[up] = half.sum();
      int side = 0;
      distance = -depth.minCoeff(&side);
      normal[side] = point[side] < 0.0 ? -1.0 : 1.0;
      nearest[side] = normal[side] * half[side];
    }
    return SectionContact{X_WB.position + R * nearest, R * normal, distance - a.radius};
  };
  return take_ends(stretch, section(stretch.low), section(stretch.high), margin, found);
}

}  // namespace cohort::physics
