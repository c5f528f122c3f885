// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/mechanism/linear_system.hpp"

namespace cohort::physics {

/// The equations (M + D + h K) x = b of one body, solved in a time proportional to its degrees of freedom. Here, x is a
/// change of the velocities. M is the mass matrix and D the added inertia by dof. K is the derivative of the bias
/// forces with respect to the velocities. With h = 0, this is the articulated-body algorithm (Featherstone, "Rigid body
/// dynamics algorithms", 2008, chapter 7).
///
/// With K, the algorithm needs two motions: x changes the velocity of a segment by dv, and its acceleration at zero
/// joint acceleration by dc. Both follow from those of the parent and from x of the joint, and the force on the segment
/// is linear in both. From the leaves to the root, the force on a segment and all that it carries is written as
/// H (dv, h dc) + p. If h = 0, the matrix H is the articulated inertia. The equations of the segment's joint eliminate
/// its part of x, which leaves the force in terms of the parent's dv and dc. From the root to the leaves, x follows.
///
/// Spatial vectors are in world axes about the joint of their segment, or about the reference point of a free root.
/// About one common point, the moments of distant segments of a long chain would lose digits.
///
/// One object serves many bodies one after the other and reuses its memory.
class ArticulatedBody {
 public:
  /// Prepares for the present poses and velocities of `body`. `added_inertia`: D, by dof. `share`: h [s].
  void set_up(const BodyMotion& body, const std::vector<double>& added_inertia, double share);
  /// Replaces b by x, both by dof.
  void solve(double* x);

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  template <int rows>
  using Columns = Eigen::Matrix<double, rows, Eigen::Dynamic>;  // by dof

  struct Part {
    int parent = -1;
    int first_dof = 0;
    int dofs = 0;
    Eigen::Vector3d point_W;             // where its spatial vectors are taken [m]
    Eigen::Vector3d way_W;               // from the parent's point to this one [m]
    Vector6 velocity;                    // angular, then linear
    Vector6 joint_velocity;              // relative to the parent
    Eigen::Matrix<double, 6, 12> force;  // H: torque and force by dv, then by h dc
  };
  using Values = Eigen::Map<Eigen::VectorXd>;  // by dof
  using Motions = Eigen::Matrix<double, 12, 1>;
  struct Change {
    Motions motion;  // dv, then h dc
    Vector6 force;   // p
  };

  void move_outwards(const BodyMotion& body);
  void find_drifts(const Part& part);
  void find_force(const Segment& segment, const Pose& X_WS, const Eigen::Matrix3d& R, const SpatialMatrix* added_mass,
                  Part& part) const;
  template <int size>
  Eigen::Matrix<double, size, size> inverse_of(const Eigen::Matrix<double, size, size>& matrix);
  template <int dofs>
  void eliminate(Part& part, const std::vector<double>& added_inertia);
  template <int dofs>
  void gather(const Part& part, Vector6& force, Values& x);
  template <int dofs>
  void spread(const Part& part, Change& change, Values& x) const;

  double share_ = 0.0;
  LinearSystem system_;          // the equations of one joint
  std::vector<Part> parts_;      // by segment
  std::vector<Change> changes_;  // by segment
  Columns<6> axes_;              // dv by a unit of x
  Columns<6> drifts_;            // h dc by a unit of x
  Columns<6> forces_;            // force by a unit of x
  Columns<6> inverses_;          // inverse of the joint's own equations, in its first rows
  Columns<12> shares_;           // transposed: what the parent's dv and h dc take from x
};

}  // namespace cohort::physics
