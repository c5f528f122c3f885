// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/dynamics/bias_forces.hpp"

namespace cohort::physics {

/// The mass matrix of one body, by the composite-rigid-body algorithm, and its branch-induced sparse factorisation L'DL
/// (Featherstone, "Rigid body dynamics algorithms", 2008, chapters 6 and 8.6). In world axes about the body's reference
/// point.
///
/// One object serves many bodies one after the other and reuses its memory.
class MassMatrix {
 public:
  using SpatialInertia = BiasForces::SpatialInertia;

  /// Computes the matrix; `segments` has the inertias of the segments at their present poses.
  void set_up(const BodyMotion& body, const std::vector<Spatial>& axes, const BiasForces& segments);
  /// Returns the inertia of one dof while all others are held.
  double inertia(int dof) const { return matrix_[static_cast<std::size_t>(dof * (stride_ + 1))]; }
  /// Adds to the inertia of one dof.
  void add_inertia(int dof, double inertia) { matrix_[static_cast<std::size_t>(dof * (stride_ + 1))] += inertia; }

  /// Factorises the matrix. Call it after all inertia was added and before `solve` and `invert`.
  void factorise();
  /// Returns the articulated inertia of one dof from the factorised matrix: earlier dofs are held, and the segments
  /// beyond the dof are free to move.
  double articulated_inertia(int dof) const { return 1.0 / matrix_[static_cast<std::size_t>(dof * (stride_ + 1))]; }
  /// Solves matrix * y = x in place.
  void solve(double* x) const;
  /// Returns whether a matrix of this size is so small that using its inverse is cheaper than solving.
  static bool is_small(int size) { return size <= most_inverted; }
  static constexpr int most_inverted = 12;
  /// Adds the matrix itself, computed from its factors, to `matrix`: rows `stride` apart.
  void add_product(double* matrix) const;
  /// Computes the inverse: one row and column per dof, rows `stride` apart.
  void invert(double* inverse) const;

 private:
  void gather_inwards();
  void take_free_root(const SpatialInertia& whole);
  void take_joint(int dof, const SpatialInertia& beyond, const SpatialMatrix* added_mass);

  const Mechanism* mechanism_ = nullptr;
  const std::vector<Spatial>* axes_ = nullptr;  // by dof
  int size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::vector<SpatialInertia> composite_;  // by segment, including all segments beyond it
  std::vector<SpatialMatrix> added_mass_;  // likewise; empty if there is none
  std::vector<double> matrix_;             // size_ x stride_, lower triangle: the mass matrix, then its factors
};

}  // namespace cohort::physics
