// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "server/core/is_unit.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::physics {

/// A point at which two solids touch or are about to.
struct ContactPoint {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();  ///< halfway between the surfaces
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();    ///< unit, from b towards a
  double gap = 0.0;                                      ///< [m]; negative if they overlap

  // The solver keeps these impulses between steps for warm starting: along the normal and two tangents [N s], against
  // rolling about the tangents and against spinning [N m s].
  std::array<double, 3> impulse{};
  std::array<double, 2> rolling_impulse{};
  double spinning_impulse = 0.0;

  /// Calls `visit`, one of core/state_visitors.hpp, for each number, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (int i = 0; i < 3; ++i) visit(self.position_W[i]);
    for (int i = 0; i < 3; ++i) visit(self.normal_W[i]);
    visit(self.gap);
    for (auto& each : self.impulse) visit(each);
    for (auto& each : self.rolling_impulse) visit(each);
    visit.unusual(self.spinning_impulse, 0.0);
  }
};

/// The contact points of one pair of solids. Four are enough for a box; a body with more corners needs more to roll
/// over all of them.
struct ContactPoints {
  static constexpr int most = 8;

  std::array<ContactPoint, most> points;
  int count = 0;
  /// The direction of the first tangent of each point in the solver (the axis of a belt), or zero if it is arbitrary.
  /// Set again in every step.
  Eigen::Vector3d friction_direction_W = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& position_W, const Eigen::Vector3d& normal_W, double gap) {
    assert(is_unit(normal_W));
    if (count < most) points[static_cast<std::size_t>(count++)] = {position_W, normal_W, gap, {}, {}, 0.0};
  }
  ContactPoint* begin() { return points.data(); }
  ContactPoint* end() { return points.data() + count; }
  const ContactPoint* begin() const { return points.data(); }
  const ContactPoint* end() const { return points.data() + count; }
};

}  // namespace cohort::physics
