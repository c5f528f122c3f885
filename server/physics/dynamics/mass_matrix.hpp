#pragma once

#include <vector>

#include "server/physics/dynamics/bias_forces.hpp"

namespace cohort::physics {

/// The mass matrix of one body, by composite rigid bodies, and its factors L'DL along the branches of the tree
/// (Featherstone, "Rigid body dynamics algorithms", 2008, chapters 6 and 8.6), in world axes about the body's reference
/// point.
///
/// One object serves many bodies one after the other; it keeps its memory.
class MassMatrix {
 public:
  using SpatialInertia = BiasForces::SpatialInertia;

  /// `inertias`: of the segments as they are.
  void set_up(const BodyMotion& body, const std::vector<Spatial>& axes, const std::vector<SpatialInertia>& inertias);
  /// Adds to what one dof resists with.
  void add_inertia(int dof, double inertia) { matrix_[static_cast<std::size_t>(dof * (stride_ + 1))] += inertia; }

  /// After all inertia was added, before the next two.
  void factorise();
  /// In place: the solution of the matrix times it = `x`.
  void solve(double* x) const;
  /// Whether the inverse is cheaper to have than to do without.
  bool is_small() const;
  /// `inverse`: as many rows and columns as there are dofs, each row `stride` after the one before.
  void invert(double* inverse) const;

 private:
  void gather_inwards();
  void take_free_root(const SpatialInertia& whole);
  void take_joint(int dof, const SpatialInertia& beyond);

  const Mechanism* mechanism_ = nullptr;
  const std::vector<Spatial>* axes_ = nullptr;  // by dof
  int size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::vector<SpatialInertia> composite_;  // by segment, with all that hangs on it
  std::vector<double> matrix_;             // size_ x stride_, lower triangle: the mass matrix, then its factors
};

}  // namespace cohort::physics
