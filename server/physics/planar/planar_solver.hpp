// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/multibody/connection.hpp"
#include "server/physics/multibody/contact_rows.hpp"
#include "server/physics/planar/planar_collision.hpp"
#include "server/physics/planar/planar_ground.hpp"

namespace cohort::physics {

/// The rows between the bodies of one island, solved by sequential impulses together with the ground under each body.
/// Each worker has one for all its islands. Solving changes velocities only. `keep` stores the impulses, except those
/// of the ground, which are always stored.
class PlanarSolver {
 public:
  /// All arrays are by member and must outlive this.
  PlanarSolver(PlanarBodies& bodies, std::vector<PlanarGround>& grounds) : bodies_(bodies), grounds_(grounds) {}

  void clear();
  void add_member(std::uint32_t member) { members_.push_back(member); }
  /// Adds a contact point between segments of two members; `Anchors::nobody` is the world.
  void add_contact(const Anchors::Part& a, const Anchors::Part& b, PlanarPoint& point, double z,
                   const SurfacePair& surfaces, double step);
  void add_connection(Connection& connection, double step);
  void solve(std::uint32_t iterations);
  /// Stores impulses and the state of tracks; call it after a valid solution.
  void keep(double step);

 private:
  struct Side {
    PlanarVelocity* velocity = nullptr;
    PlanarInertia inertia;
    Eigen::Vector2d centre_W = Eigen::Vector2d::Zero();
  };
  struct ContactRows {
    Side a;
    Side b;
    Eigen::Vector2d normal_W;
    double normal_lever_a = 0.0, normal_lever_b = 0.0, normal_mass = 0.0, normal_target = 0.0;
    double side_lever_a = 0.0, side_lever_b = 0.0, side_mass = 0.0, side_target = 0.0;
    double friction = 0.0;
    double normal_impulse = 0.0, side_impulse = 0.0;
    PlanarPoint* point = nullptr;
  };
  struct ConnectionRows {
    Side a;
    Side b;
    Eigen::Vector2d from_a_W, from_b_W;  // from the centres of mass to the connection
    Eigen::Matrix3d mass;
    Eigen::Vector3d target;
    Eigen::Vector3d impulse;
    Connection* connection = nullptr;
  };
  Side side_of(std::uint32_t member);
  /// Returns the velocity that the joints give to a point of the body: x, y and rotation.
  Eigen::Vector3d joint_velocity(const Anchors::Part& part, const Eigen::Vector3d& point_W) const;
  void begin();
  static void push(ContactRows& rows, double along_normal, double sideways);
  static void push(ConnectionRows& rows, const Eigen::Vector3d& impulse);
  static double solve(ContactRows& rows);
  static double solve(ConnectionRows& rows);

  PlanarBodies& bodies_;
  std::vector<PlanarGround>& grounds_;
  PlanarVelocity world_;  // stays zero
  std::vector<std::uint32_t> members_;
  std::vector<ContactRows> contacts_;
  std::vector<ConnectionRows> connections_;
};

}  // namespace cohort::physics
