// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "server/geometry/shapes/footprint.hpp"

namespace cohort::physics {

/// A point at which two outlines touch or are about to.
struct PlanarPoint {
  Eigen::Vector2d position_W = Eigen::Vector2d::Zero();  ///< halfway between the outlines
  Eigen::Vector2d normal_W = Eigen::Vector2d::Zero();    ///< unit, from b towards a
  double gap = 0.0;                                      ///< [m]; negative if they overlap

  // Impulses that the solver keeps between steps for warm starting [N s].
  double normal_impulse = 0.0;
  double friction_impulse = 0.0;  ///< on a, along the normal rotated 90 degrees to the left

  /// Calls `visit` for each number, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (int i = 0; i < 2; ++i) visit(self.position_W[i]);
    for (int i = 0; i < 2; ++i) visit(self.normal_W[i]);
    visit(self.gap);
    visit(self.normal_impulse);
    visit(self.friction_impulse);
  }
};

/// The points of one pair of outlines; two support any edge on any other.
struct PlanarPoints {
  static constexpr int most = 2;

  std::array<PlanarPoint, most> points;
  int count = 0;

  void add(const Eigen::Vector2d& position_W, const Eigen::Vector2d& normal_W, double gap) {
    if (count < most) points[static_cast<std::size_t>(count++)] = {position_W, normal_W, gap, 0.0, 0.0};
  }
  PlanarPoint* begin() { return points.data(); }
  PlanarPoint* end() { return points.data() + count; }
  const PlanarPoint* begin() const { return points.data(); }
  const PlanarPoint* end() const { return points.data() + count; }
};

/// The half-plane behind an infinite upright wall.
struct HalfPlane {
  Eigen::Vector2d normal_W = Eigen::Vector2d::UnitX();  ///< unit, outward
  double offset = 0.0;                                  ///< position of the surface along the normal [m]
};

/// Adds the points where two outlines are nearer than `margin` [m]; heights are ignored. Exact for discs and
/// rectangles. For two rounded rectangles, both with edges, the nearest points are used beyond their corners.
void find_planar_contact(const geometry::Footprint& a, const geometry::Footprint& b, double margin,
                         PlanarPoints& found);
void find_planar_contact(const geometry::Footprint& a, const HalfPlane& b, double margin, PlanarPoints& found);

}  // namespace cohort::physics
