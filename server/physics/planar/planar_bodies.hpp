// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "server/physics/multibody/joint_rows.hpp"
#include "server/physics/planar/planar_model.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The pose of a body's frame B. Its origin is at the centre of mass in the plane z = 0; its axes were the world's when
/// the body was placed.
struct PlanarPlace {
  double x = 0.0;
  double y = 0.0;
  double turn_w = 1.0;  ///< cosine and sine of half its rotation since it was placed
  double turn_z = 0.0;
  double cosine = 1.0;  ///< cosine and sine of the rotation, computed from the half
  double sine = 0.0;

  Eigen::Vector2d rotate(const Eigen::Vector2d& vector_B) const {
    return {cosine * vector_B.x() - sine * vector_B.y(), sine * vector_B.x() + cosine * vector_B.y()};
  }
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_B) const { return Eigen::Vector2d(x, y) + rotate(point_B); }
  Pose operator*(const Pose& X_BC) const;
  void find_whole_turn() {
    cosine = turn_w * turn_w - turn_z * turn_z;
    sine = 2.0 * turn_w * turn_z;
  }
};

/// The velocity of the centre of mass [m/s], and the angular velocity [rad/s].
struct PlanarVelocity {
  double x = 0.0;
  double y = 0.0;
  double spin = 0.0;
};

/// Inverse mass and inertia; zero for a body that is fixed to the world.
struct PlanarInertia {
  double inverse_mass = 0.0;     ///< [1/kg]
  double inverse_inertia = 0.0;  ///< [1/(kg m^2)]
};

/// The moving bodies, as arrays over members: their poses and velocities, and the poses of their links.
class PlanarBodies {
 public:
  /// Adds a member and returns its index, which counts up. The model must outlive this.
  std::uint32_t add(const PlanarModel& model, const Pose& X_WM);

  /// Places a member as `add` does, with its joints at zero.
  void renew(std::uint32_t member, const Pose& X_WM);

  std::size_t size() const { return members_.size(); }
  const PlanarModel& model(std::uint32_t member) const { return *members_[member].model; }
  const PlanarPlace& place(std::uint32_t member) const { return places_[member]; }
  const PlanarInertia& inertia(std::uint32_t member) const { return inertias_[member]; }
  PlanarVelocity& velocity(std::uint32_t member) { return velocities_[member]; }
  const PlanarVelocity& velocity(std::uint32_t member) const { return velocities_[member]; }

  const Pose& segment_in_body(std::uint32_t member, int segment) const {  ///< X_BS
    return X_BS_[members_[member].first_segment + static_cast<std::size_t>(segment)];
  }
  Pose segment_pose(std::uint32_t member, int segment) const {  ///< X_WS
    return places_[member] * segment_in_body(member, segment);
  }
  Pose link_pose(std::uint32_t member, std::size_t link) const;
  Twist link_twist(std::uint32_t member, std::size_t link) const;
  double joint_position(std::uint32_t member, std::size_t joint) const;
  double joint_velocity(std::uint32_t member, std::size_t joint) const;

  /// Places the model at X_WM, at rest, with its joints unchanged.
  void place(std::uint32_t member, const Pose& X_WM);
  void stop(std::uint32_t member);
  /// Changes the velocities by an impulse at a point and an angular impulse [N s, N m s].
  void push(std::uint32_t member, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
            const Eigen::Vector3d& angular_impulse_W);
  void set_root_twist(std::uint32_t member, const Twist& twist);
  void set_joint_state(std::uint32_t member, std::size_t joint, std::span<const double> coordinates,
                       std::span<const double> velocities);
  /// Sets the command of a joint, which must have a motor.
  void set_joint_target(std::uint32_t member, std::size_t joint, JointRows::Control control, double target);

  /// Sets the joint velocities of this step to those commanded, within the joints' limits.
  void drive_joints(std::uint32_t index, double step);
  /// Returns whether any motor turns in this step.
  bool has_moving_joints(std::uint32_t member) const { return members_[member].has_moving_joints; }
  /// Returns the twist relative to B that the joints give to a point of a segment.
  Twist twist_in_body(std::uint32_t index, int segment, const Eigen::Vector3d& point_W) const;
  /// Returns false if the next step would overflow.
  bool is_sensible(std::uint32_t index) const;
  /// Moves the body with the velocities of this step. Returns true if segments moved relative to B.
  bool integrate(std::uint32_t index, double step);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, std::uint32_t member, Visit&& visit) {
    auto& place = self.places_[member];
    visit(place.x);
    visit(place.y);
    visit(place.turn_w);
    visit(place.turn_z);
    auto& velocity = self.velocities_[member];
    visit(velocity.x);
    visit(velocity.y);
    visit(velocity.spin);
    const auto& info = self.members_[member];
    const std::size_t coordinates = info.model->mechanism().zero_coordinates().size();
    for (std::size_t i = 0; i < coordinates; ++i) visit(self.coordinates_[info.first_coordinate + i]);
    for (std::size_t i = 0; i < info.model->motors().size(); ++i) {
      visit(self.motors_[info.first_motor + i].target);
      visit(self.motors_[info.first_motor + i].velocity);
      visit.unusual(self.motors_[info.first_motor + i].control, JointRows::Control::velocity);
    }
  }
  /// Updates the poses after the state was changed through `visit_state`.
  void update_poses(std::uint32_t member);

 private:
  struct Member {
    const PlanarModel* model = nullptr;
    std::size_t first_segment = 0;
    std::size_t first_coordinate = 0;
    std::size_t first_motor = 0;
    bool has_moving_joints = false;
  };
  struct Motor {
    double target = 0.0;
    double velocity = 0.0;
    JointRows::Control control = JointRows::Control::velocity;
  };
  void update_segments(const Member& member);
  void put(std::uint32_t index, const Pose& X_WM);

  std::vector<Member> members_;
  std::vector<PlanarPlace> places_;
  std::vector<PlanarVelocity> velocities_;
  std::vector<PlanarInertia> inertias_;
  std::vector<Pose> X_BS_;
  std::vector<double> coordinates_;
  std::vector<Motor> motors_;
};

inline Pose PlanarPlace::operator*(const Pose& X_BC) const {
  const Eigen::Vector3d& p = X_BC.position;
  const Eigen::Quaterniond& q = X_BC.orientation;
  return {{x + cosine * p.x() - sine * p.y(), y + sine * p.x() + cosine * p.y(), p.z()},
          {turn_w * q.w() - turn_z * q.z(), turn_w * q.x() - turn_z * q.y(), turn_w * q.y() + turn_z * q.x(),
           turn_w * q.z() + turn_z * q.w()}};
}

}  // namespace cohort::physics
