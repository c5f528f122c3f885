#pragma once

#include <vector>

#include "server/physics/multibody/multibody.hpp"

namespace cohort::physics {

/// The equations of motion of one multibody over one step: its velocities without any impulse, and how an impulse
/// changes them. Composite rigid bodies and recursive Newton-Euler for the mass matrix and the bias force, and its
/// factors L'DL along the branches of the tree (Featherstone, "Rigid body dynamics algorithms", 2008, chapters 5, 6 and
/// 8.6), in world axes about the body's reference point. Damping and springs of the joints are implicit: they are part
/// of the matrix, and so stable at any stiffness; so is what the rotors of geared motors resist (chapter 9.6).
///
/// One object serves many bodies one after the other; it keeps its memory.
class Equations {
 public:
  /// For the present state of `body`, under `gravity` [m/s^2], over `step` [s].
  void set_up(const Multibody& body, const Eigen::Vector3d& gravity, double step);

  const Multibody& body() const { return *body_; }
  const Mechanism& mechanism() const { return *mechanism_; }
  int size() const { return size_; }                 ///< degrees of freedom
  std::ptrdiff_t stride() const { return stride_; }  ///< doubles of every vector below, zero beyond `size`

  /// The velocities: at first without impulses, then as the solver changes them.
  double* velocity() { return velocity_.data(); }
  const double* velocity() const { return velocity_.data(); }

  /// Adds to `jacobian` the generalised force of a unit force along `direction_W` at `point_W` of a segment.
  void add_force(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                 double* jacobian) const;
  /// The same of a unit torque.
  void add_torque(int segment, const Eigen::Vector3d& direction_W, double* jacobian) const;
  /// Changes the velocities by an impulse at `point_W` of a segment and an angular impulse on it [N s, N m s].
  void push(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
            const Eigen::Vector3d& angular_impulse_W);
  /// The same by an impulse along one dof of a joint.
  void push_dof(int dof, double impulse);
  /// `response`: the change of the velocities by the generalised impulse `jacobian`.
  void respond(const double* jacobian, double* response) const;

 private:
  struct Spatial {  // of a velocity or an acceleration; of a force: the torque and the force
    Eigen::Vector3d angular;
    Eigen::Vector3d linear;
  };
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
  void add_generalised(int segment, const Spatial& force, double* jacobian) const;
  void factorise();
  void invert();
  void solve(double* x) const;

  const Multibody* body_ = nullptr;
  const Mechanism* mechanism_ = nullptr;
  int size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::vector<Work> work_;
  std::vector<Spatial> axes_;    // by dof; those of a free root stay unused
  std::vector<double> matrix_;   // size_ x stride_, lower triangle: the mass matrix, then its factors
  std::vector<double> inverse_;  // of the mass matrix, size_ x stride_
  bool is_inverted_ = false;     // whether inverse_ is of this body
  std::vector<double> bias_;
  std::vector<double> velocity_;
};

}  // namespace cohort::physics
