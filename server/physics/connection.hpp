#pragma once

#include <array>

#include "server/physics/anchors.hpp"
#include "server/physics/multibody.hpp"
#include "server/physics/rows.hpp"
#include "server/physics/world.hpp"

namespace cohort::physics {

/// Two segments held together as they were when they were connected.
class Connection {
 public:
  /// One end: a segment of a body that moves, or the world if there is no body. `X_SP`: the frame of the connection.
  struct End {
    std::uint32_t member = Anchors::nobody;
    int segment = 0;
    Pose X_SP;
  };

  /// `a` is on a body that moves.
  Connection(const End& a, const End& b, const ConnectionLimits& limits) : a_(a), b_(b), limits_(limits) {}

  const End& a() const { return a_; }
  const End& b() const { return b_; }
  const ConnectionLimits& limits() const { return limits_; }
  bool holds() const { return holds_; }
  void release();

  /// Adds three rows against moving apart and three against turning; X_WS: of the segments of both ends.
  void add_rows(Problem& problem, const Anchors& anchors, const Pose& X_WSa, const Pose& X_WSb, double step);
  /// On a by b over the last step: linear [N s], then angular [N m s], in world axes. For a solver with rows of its
  /// own.
  std::array<double, 6>& impulses() { return impulses_; }
  /// On a by b, at the connection, over the last step.
  Wrench wrench(double step) const;
  /// Whether the last step took more than it can bear.
  bool is_overloaded(double step) const;

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    visit(self.holds_);
    for (auto& impulse : self.impulses_) visit(impulse);
  }

 private:
  End a_;
  End b_;
  ConnectionLimits limits_;
  bool holds_ = true;
  std::array<double, 6> impulses_{};  // linear [N s], then angular [N m s], in world axes
};

}  // namespace cohort::physics
