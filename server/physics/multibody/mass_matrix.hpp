#pragma once

#include <vector>

#include "server/physics/multibody/joint_axes.hpp"
#include "server/physics/multibody/multibody.hpp"

namespace cohort::physics {

/// The mass matrix and the bias force of one body, by composite rigid bodies and recursive Newton-Euler, and the
/// matrix's factors L'DL along the branches of the tree (Featherstone, "Rigid body dynamics algorithms", 2008, chapters
/// 5, 6 and 8.6), in world axes about the body's reference point.
///
/// One object serves many bodies one after the other; it keeps its memory.
class MassMatrix {
 public:
  /// For the present state of `body`, under `gravity` [m/s^2].
  void set_up(const Multibody& body, const std::vector<Spatial>& axes, const Eigen::Vector3d& gravity);
  /// Generalised force that the body's motion and gravity take, by dof [N] or [N m].
  double bias(int dof) const { return bias_[static_cast<std::size_t>(dof)]; }
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
  struct Work {  // of one segment
    Spatial velocity;
    Spatial acceleration;
    Spatial force;
    Eigen::Matrix3d inertia;  // about the reference
    Eigen::Vector3d moment;   // mass times the centre's offset from the reference
    double mass = 0.0;
  };

  void move_outwards(const Eigen::Vector3d& gravity);
  void gather_inwards();
  void take_free_root(const Work& whole);
  void take_joint(int dof, const Work& beyond);

  const Multibody* body_ = nullptr;
  const Mechanism* mechanism_ = nullptr;
  const std::vector<Spatial>* axes_ = nullptr;  // by dof
  int size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::vector<Work> work_;
  std::vector<double> matrix_;  // size_ x stride_, lower triangle: the mass matrix, then its factors
  std::vector<double> bias_;
};

}  // namespace cohort::physics
