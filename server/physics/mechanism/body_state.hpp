// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"

namespace cohort::physics {

/// The state of a body: its pose and velocities. The object stores the numbers itself, or points to those of a body of
/// Bullet.
class BodyState {
 public:
  /// Pointers to a state that is kept elsewhere.
  struct Memory {
    double* reference = nullptr;         ///< 3: the point where spatial velocities are taken
    double* rotation = nullptr;          ///< 4, x y z w: rotation of a free root
    bool is_from_world = false;          ///< true if the rotation is from the world to the root
    double* velocities = nullptr;        ///< by dof
    std::vector<double*> coordinates{};  ///< each coordinate; those of one segment are contiguous
  };

  /// Creates a state with all joints at zero.
  explicit BodyState(const Mechanism& mechanism);
  BodyState(const Mechanism& mechanism, Memory memory);

  Eigen::Vector3d reference() const { return Eigen::Map<const Eigen::Vector3d>(memory_.reference); }
  // NOLINTBEGIN(readability-make-member-function-const): what they give access to is the state.
  void set_reference(const Eigen::Vector3d& reference_W) {
    Eigen::Map<Eigen::Vector3d>(memory_.reference) = reference_W;
  }
  Eigen::Quaterniond root_rotation() const;
  void set_root_rotation(const Eigen::Quaterniond& rotation);
  double* velocities() { return memory_.velocities; }
  // NOLINTEND(readability-make-member-function-const)
  const double* velocities() const { return memory_.velocities; }
  /// Returns the coordinates of a segment, whose first one is `first`, or nullptr if it has none.
  double* coordinates(int first) {
    const auto index = static_cast<std::size_t>(first);
    return index < memory_.coordinates.size() ? memory_.coordinates[index] : nullptr;
  }
  const double* coordinates(int first) const { return const_cast<BodyState&>(*this).coordinates(first); }

  /// Calls `visit` for each number, always in the same order.
  template <class Self, class Visit>
  static void visit(Self& self, Visit&& visit) {
    visit_each(self.memory_.reference, 3, visit);
    visit_each(self.memory_.rotation, 4, visit);
    for (double* coordinate : self.memory_.coordinates) visit(*coordinate);
    visit_each(self.memory_.velocities, self.dofs_, visit);
  }

 private:
  template <class Visit>
  static void visit_each(double* numbers, int count, Visit& visit) {
    for (int i = 0; i < count; ++i) visit(numbers[i]);
  }

  int dofs_;
  std::vector<double> own_;
  Memory memory_;
};

}  // namespace cohort::physics
