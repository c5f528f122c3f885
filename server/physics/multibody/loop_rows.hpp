// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"

namespace cohort::physics {

class BodyMotion;
class Problem;

/// The joints of one body that close kinematic loops, as rows between two of its segments or between a segment and the
/// world. Each step corrects the position error of the previous step.
class LoopRows {
 public:
  explicit LoopRows(const Mechanism& mechanism);

  void add_rows(Problem& problem, int index, const BodyMotion& body, double step);
  /// Returns whether one of these joints is attached to the world.
  bool reach_the_world() const;
  /// Returns whether one of these joints connects the two segments.
  bool connect(int segment, int other) const;
  /// Calls `visit(parent, child, point_W, linear_W, angular_W)` for each joint: its two links, and the impulse on the
  /// child in the last step at a point [N s, N m s].
  template <class Visit>
  void for_each_impulse(Visit&& visit) const {
    for (const Loop& loop : loops_) {
      Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();
      Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();
      for (int i = 0; i < loop.errors.count; ++i)
        (i < loop.errors.linear ? linear_W : angular_W) += loop.impulses[at(i)] * loop.errors.directions_W[at(i)];
      visit(loop.parent_link, loop.child_link, loop.point_W, linear_W, angular_W);
    }
  }

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& loop : self.loops_)
      for (auto& impulse : loop.impulses) visit(impulse);
  }

 private:
  static constexpr std::size_t most_rows = 6;

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// The directions of the rows of a loop and its errors along them: `linear` ones against translation [m], then those
  /// against rotation [rad].
  struct Errors {
    std::array<Eigen::Vector3d, most_rows> directions_W{};
    std::array<double, most_rows> off{};
    int linear = 0;
    int count = 0;

    void add(const Eigen::Vector3d& direction_W, double how_much) {
      directions_W[at(count)] = direction_W;
      off[at(count++)] = how_much;
    }
  };
  struct Loop {
    description::JointType type = description::JointType::fixed;
    std::size_t parent_link = 0;
    std::size_t child_link = 0;
    int parent = -1;  // segment; -1: the world
    int child = 0;
    Pose X_SP_parent;  // the joint's frame in the parent; in the model's frame for the world
    Pose X_SP_child;
    Eigen::Vector3d axis_P = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d second_axis_P = Eigen::Vector3d::UnitZ();
    std::array<double, most_rows> impulses{};
    // Data of this step:
    Errors errors;
    Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  };
  static Errors errors_of(const Loop& loop, const Pose& X_WPp, const Pose& X_WPc);

  std::vector<Loop> loops_;
};

}  // namespace cohort::physics
