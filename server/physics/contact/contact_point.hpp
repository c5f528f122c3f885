#pragma once

#include <array>
#include <cstdint>

#include "server/geometry/shapes/shapes.hpp"

namespace cohort::physics {

/// Where two solids touch, or are about to.
struct ContactPoint {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();  ///< halfway between the surfaces
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();    ///< unit, from b towards a
  double gap = 0.0;                                      ///< [m], negative: they overlap

  // What the solver keeps from step to step: impulses along the normal and two tangents [N s], and against rolling
  // about the tangents and spinning about the normal [N m s].
  std::array<double, 3> impulse{};
  std::array<double, 2> rolling_impulse{};
  double spinning_impulse = 0.0;

  /// Calls `visit` for each number, always in the same order: one of core/state_visitors.hpp.
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

/// The points of one pair of solids; four hold any face on any other.
struct ContactPoints {
  static constexpr int most = 4;

  std::array<ContactPoint, most> points;
  int count = 0;
  /// Along which the solver has laid the first tangent of each, of a belt its axis; zero: anywhere. Told anew in every
  /// step.
  Eigen::Vector3d friction_direction_W = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& position_W, const Eigen::Vector3d& normal_W, double gap) {
    if (count < most) points[static_cast<std::size_t>(count++)] = {position_W, normal_W, gap, {}, {}, 0.0};
  }
  ContactPoint* begin() { return points.data(); }
  ContactPoint* end() { return points.data() + count; }
  const ContactPoint* begin() const { return points.data(); }
  const ContactPoint* end() const { return points.data() + count; }
};

}  // namespace cohort::physics
