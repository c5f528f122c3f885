#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"

namespace cohort::physics {

/// The numbers that say where a body is and how it moves, wherever they are kept: in memory of their own, or in a body
/// of Bullet.
class BodyState {
 public:
  /// What is kept elsewhere.
  struct Memory {
    double* reference = nullptr;         ///< 3: the point where spatial velocities are taken
    double* rotation = nullptr;          ///< 4, x y z w: of a free root
    bool is_from_world = false;          ///< whether the rotation turns from the world to the root
    double* velocities = nullptr;        ///< by dof
    std::vector<double*> coordinates{};  ///< each coordinate; those of a segment stand together
  };

  /// With all joints at zero.
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
  /// From this one on, as many as its segment has; nullptr if there is none.
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
