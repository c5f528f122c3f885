// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// Two segments held together in the relative pose in which they were connected, or to which they slipped.
class Connection {
 public:
  /// One end: a segment of a moving body, or the world if there is no body. `X_SP`: the frame of the connection.
  struct End {
    std::uint32_t member = Anchors::nobody;
    int segment = 0;
    std::uint32_t link = 0;  ///< link of the model; several may form one segment
    Pose X_SP;
    std::uint32_t body = 0;  ///< body of the world, moving or not
  };
  using Impulses = std::array<double, 6>;  ///< linear [N s], then angular [N m s]

  /// `a` must be on a moving body.
  Connection(const End& a, const End& b, const ConnectionLimits& limits) : a_(a), b_(b), limits_(limits) {}

  const End& a() const { return a_; }
  const End& b() const { return b_; }
  const ConnectionLimits& limits() const { return limits_; }
  const ConnectionGive& give() const { return give_; }
  void set_give(const ConnectionGive& give);
  bool holds() const { return holds_; }
  void release();
  /// Releases a connection that its load in the last step has broken. The wrench of that step remains available until
  /// the end of the next step.
  void break_now();

  /// Poses X_WS of the segments of both ends.
  struct Ends {
    Pose a;
    Pose b;
  };
  /// Adds three rows against relative translation and three against rotation. `ahead`: the ends after a step with the
  /// present velocities.
  void add_rows(Problem& problem, const Anchors& anchors, const Ends& X_WS, const Ends& ahead, double step);
  /// Returns whether `settle` must be called after each step.
  bool may_slip() const { return yields_; }
  /// Stores the impulses of the step and, if the connection slipped, its new rest pose.
  void settle(const Pose& X_WSa, const Pose& X_WSb, double step);

  /// Returns the impulses on a by b over the last step, in world axes, at `point`. Mutable for a solver with its own
  /// rows.
  Impulses& impulses() { return impulses_; }
  const Impulses& impulses() const { return impulses_; }
  /// Returns the point of the last step's rows, halfway between the two ends.
  const Eigen::Vector3d& point() const { return point_W_; }
  /// Returns the mean wrench over the last step at `point`. X_WSa and X_WSb: poses of the segments of both ends.
  Wrench wrench_on_a(const Pose& X_WSa, const Pose& X_WSb, double step) const;
  Wrench wrench_on_b(const Pose& X_WSa, const Pose& X_WSb, double step) const;
  /// Returns whether the load of the last step exceeded its limits.
  bool is_overloaded(double step) const;

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    visit(self.holds_);
    for (auto& impulse : self.impulses_) visit(impulse);
    visit.unusual(self.yields_, false);
    if (!self.yields_) return;
    visit(self.give_.linear_stiffness);
    visit(self.give_.linear_damping);
    visit(self.give_.holding_force);
    for (auto* each : {&self.give_.angular_stiffness, &self.give_.angular_damping, &self.give_.holding_torque})
      for (int axis = 0; axis < 3; ++axis) visit((*each)[axis]);
    for (int i = 0; i < 3; ++i) visit(self.b_.X_SP.position[i]);
    for (int i = 0; i < 4; ++i) visit(self.b_.X_SP.orientation.coeffs()[i]);
  }

 private:
  struct Spring {
    double stiffness;
    double damping;
    double limit;

    bool is_free() const { return limit == 0.0 || (stiffness == 0.0 && damping == 0.0); }
  };
  Spring spring(int axis) const;
  /// The displacement from frame P as fixed to b to P as fixed to a, along the axes of the rows.
  struct Errors {
    Eigen::Vector3d gap;
    Eigen::Vector3d twist;  ///< rotation vector

    double operator[](int axis) const { return axis < 3 ? gap[axis] : twist[axis - 3]; }
  };
  Errors errors_at(const Ends& X_WS) const;
  static void make_yielding(Row& row, const Spring& spring, double off, double step);
  const Impulses& last() const { return holds_ ? impulses_ : breaking_; }

  End a_;
  End b_;
  ConnectionLimits limits_;
  ConnectionGive give_;
  bool holds_ = true;
  bool yields_ = false;  // it is or was compliant
  Impulses impulses_{};
  // Data of the last step, not part of the state:
  Impulses breaking_{};
  Impulses row_impulses_{};  // if compliant: along the axes of P
  Eigen::Matrix3d axes_W_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d point_W_ = Eigen::Vector3d::Zero();
  bool has_rows_ = false;
};

}  // namespace cohort::physics
