// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "server/geometry/visibility/outlines.hpp"

namespace cohort::geometry {

/// Distances around a point in a plane: rays in many directions at once, on flat ground, with each solid approximated
/// by a bounding shape. The thesis calls this technique shadows (section 3.2.1): it "shoots 360 rays around the robot,
/// however it only works with a 2D plane". Each object is in a bounding cylinder or an oriented bounding box. The
/// appendix with its algorithm is lost, so this algorithm is Cohort's own.
///
/// Around the centre p, direction k of N has the bearing b_k = 2 pi k / N from the ring's x axis and the unit vector
/// u_k. A solid that crosses the plane at p's height casts a shadow on the directions between its two tangents, and
/// only these are tested. With its centre c relative to p and d = |c|:
///
/// - A circle of radius r covers the bearings within asin(r / d) of that of c. On u_k it begins at
///   u_k . c - sqrt(r^2 - (u_k x c)^2), if the root is real.
///
/// - A rectangle covers the bearings between those of its outermost corners. In its own axes, p is at s and u_k is v.
///   It begins at the greatest of (-h_i sign(v_i) - s_i) / v_i over both axes i, unless it ends before, at the least of
///   (h_i sign(v_i) - s_i) / v_i. This is the slab method (Kay and Kajiya, "Ray tracing complex scenes", SIGGRAPH
///   1986).
///
/// - A plane that is not level is cut in a line with outward normal n at the height h of p above it. Its distance is
///   -h / (u_k . n) wherever that is positive.
///
/// Each direction keeps the least distance over all solids. If p lies inside a solid, all distances are 0. Level planes
/// and height maps are ground and are never seen. The distance is that of a ray, within rounding, for a solid that is a
/// circle or an upright box with the same height everywhere. For all others, the bounding shape is hit too early.
class ShadowRing {
 public:
  /// Throws std::invalid_argument unless `directions` >= 4.
  explicit ShadowRing(std::size_t directions = 360);

  std::size_t size() const { return directions_R_.size(); }
  /// Returns the unit vector of a direction in the frame R of the ring.
  const Eigen::Vector2d& direction(std::size_t index) const { return directions_R_[index]; }

  /// Writes the distance [m] of the nearest solid in each direction from p_WR, at most `range` away, or infinity.
  /// `heading` is the bearing of the ring's x axis in the world [rad]. Solids of `ignored_body` are ignored.
  /// `distances` has `size()` elements. Const, callable from any thread.
  void cast(const Scene& scene, const Eigen::Vector3d& p_WR, double heading, double range, BodyId ignored_body,
            std::span<double> distances) const;

 private:
  /// A circle or a rectangle in the plane, in the frame R.
  struct Shadow {
    Eigen::Vector2d centre;
    Eigen::Vector2d axis;
    Eigen::Vector2d half;
    double radius;
  };

  void shade_by_circle(const Shadow& circle, double range, std::span<double> distances) const;
  void shade_by_rectangle(const Shadow& rectangle, double range, std::span<double> distances) const;
  void shade_by_line(const Eigen::Vector2d& normal, double height, double range, std::span<double> distances) const;
  /// Calls `visit(k)` for each direction from one bearing to a greater one, and for one more on either side.
  template <class Visit>
  void for_each_between(double first_bearing, double last_bearing, Visit&& visit) const;

  std::vector<Eigen::Vector2d> directions_R_;
};

}  // namespace cohort::geometry
