// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/dynamics/articulated_body.hpp"
#include "server/physics/dynamics/bias_forces.hpp"
#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/dynamics/joint_axes.hpp"
#include "server/physics/dynamics/mass_matrix.hpp"

namespace cohort::physics {

/// Limit of (step * angular frequency)^2 of a spring. Up to this limit, the spring keeps all its energy.
inline constexpr double fastest_spring = 64.0;

/// The equations of motion of one body over one step: its velocities without any impulse, and how an impulse changes
/// them. They use the dynamics that the body has: Bullet's, or Cohort's own. Damping and springs of joints are
/// integrated implicitly: they add to the inertia, and are therefore stable at any stiffness. The rotor inertia of
/// geared motors is added too (Featherstone, "Rigid body dynamics algorithms", 2008, chapter 9.6). Bias forces are
/// taken at the beginning of the step. If a part spins fast, they are taken at its middle instead (linearly implicit
/// midpoint rule).
///
/// Small bodies are solved by their mass matrix. Bodies that spin fast and bodies with many degrees of freedom are
/// solved by recursion (ArticulatedBody).
///
/// One object serves many bodies one after the other and reuses its memory.
class Equations {
 public:
  /// Prepares for the present state of `body` under `gravity` [m/s^2] over `step` [s]. `is_held`: whether anything else
  /// touches or holds the body.
  void set_up(const BodyMotion& body, const Eigen::Vector3d& gravity, double step, bool is_held);

  const BodyMotion& body() const { return *body_; }
  const Mechanism& mechanism() const { return *mechanism_; }
  int size() const { return size_; }                 ///< degrees of freedom
  std::ptrdiff_t stride() const { return stride_; }  ///< length of every vector below, zero beyond `size`

  /// Returns whether the response matrix is symmetric. It is not if a part spins so fast that its gyroscopic torques
  /// are taken at the middle of the step.
  bool is_symmetric() const { return is_symmetric_; }

  /// Returns the velocities: without impulses at first, then as the solver changes them.
  double* velocity() { return velocity_.data(); }
  const double* velocity() const { return velocity_.data(); }

  /// Adds to `jacobian` the generalised force of a unit force along `direction_W` at `point_W` of a segment.
  void add_force(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                 double* jacobian) const;
  /// Adds to `jacobian` the generalised force of a unit torque.
  void add_torque(int segment, const Eigen::Vector3d& direction_W, double* jacobian) const;
  /// Changes the velocities by an impulse at `point_W` of a segment and an angular impulse on it [N s, N m s].
  void push(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
            const Eigen::Vector3d& angular_impulse_W);
  /// Returns the sum of these pushes since `set_up`: their impulse, and its moment about the body's reference point.
  const Spatial& pushed() const { return pushed_; }
  /// Adds to `pushed` a push for which the caller has already changed the velocities.
  void count_push(const Eigen::Vector3d& point_W, const Spatial& impulse_W) {
    pushed_.angular += impulse_W.angular + (point_W - body_->reference()).cross(impulse_W.linear);
    pushed_.linear += impulse_W.linear;
  }
  /// Changes the velocities by an impulse along one dof of a joint.
  void push_dof(int dof, double impulse);
  /// Adds the mass matrix, with everything that acts like inertia, to `matrix`: rows `stride` apart. Only if the
  /// response is symmetric.
  void add_inertia(double* matrix) const;
  /// Computes into `response` the change of the velocities by the generalised impulse `jacobian`.
  void respond(const double* jacobian, double* response);

 private:
  void find_efforts(double step);
  void solve_by_mass_matrix(const Eigen::Vector3d& gravity, double step);
  void solve_by_bullet(const Eigen::Vector3d& gravity, double step);
  void solve_by_recursion(const Eigen::Vector3d& gravity, double step);
  void find_growth(const double* change, double* growth);
  void add_generalised(int segment, const Spatial& force, double* jacobian) const;

  const BodyMotion* body_ = nullptr;
  const Mechanism* mechanism_ = nullptr;
  int size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::vector<Spatial> axes_;          // by dof
  std::vector<double> efforts_;        // efforts of dampers and springs, by dof
  std::vector<double> added_inertia_;  // from dampers, springs and rotors, by dof
  MassMatrix matrix_;
  BiasForces bias_;
  ArticulatedBody articulated_;
  std::vector<double> shifted_;  // scratch, by dof
  std::vector<double> opposite_;
  bool is_symmetric_ = true;
  bool is_recursive_ = false;    // true if articulated_ belongs to this body
  std::vector<double> inverse_;  // size_ x stride_: by dof, the response to a unit impulse along it
  bool is_inverted_ = false;     // true if inverse_ belongs to this body
  std::vector<double> velocity_;
  std::vector<double> response_;
  Spatial pushed_;
};

}  // namespace cohort::physics
