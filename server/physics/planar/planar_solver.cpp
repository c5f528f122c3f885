// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>

#include "server/core/is_unit.hpp"
#include "server/core/plane_vectors.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// The iteration ends after a pass that changes no velocity by more than this [m/s or rad/s].
constexpr double tolerance = 1e-9;

double along(const Vector2d& direction, double lever, const PlanarVelocity& velocity) {
  return direction.x() * velocity.x + direction.y() * velocity.y + lever * velocity.spin;
}

}  // namespace

void PlanarSolver::clear() {
  members_.clear();
  contacts_.clear();
  connections_.clear();
  world_ = {};
}

PlanarSolver::Side PlanarSolver::side_of(std::uint32_t member) {
  if (member == Anchors::nobody) return {&world_, {}, Vector2d::Zero()};
  const PlanarPlace& place = bodies_.place(member);
  return {&bodies_.velocity(member), bodies_.inertia(member), Vector2d(place.x, place.y)};
}

Vector3d PlanarSolver::joint_velocity(const Anchors::Part& part, const Vector3d& point_W) const {
  if (part.member == Anchors::nobody || !bodies_.has_moving_joints(part.member)) return Vector3d::Zero();
  const Twist twist = bodies_.twist_in_body(part.member, part.segment, point_W);
  return {twist.linear_W.x(), twist.linear_W.y(), twist.angular_W.z()};
}

void PlanarSolver::add_contact(const Anchors::Part& part_a, const Anchors::Part& part_b, PlanarPoint& point, double z,
                               const SurfacePair& surfaces, double step) {
  assert(is_unit(point.normal_W));
  ContactRows& rows = contacts_.emplace_back();
  rows.a = side_of(part_a.member);
  rows.b = side_of(part_b.member);
  rows.normal_W = point.normal_W;
  rows.point = &point;
  rows.friction = surfaces.friction;
  const Vector2d from_a = point.position_W - rows.a.centre_W;
  const Vector2d from_b = point.position_W - rows.b.centre_W;
  const Vector2d side_W = left_of(point.normal_W);
  const auto mass_of = [&](double lever_a, double lever_b) {
    const double mobility = rows.a.inertia.inverse_mass + rows.b.inertia.inverse_mass +
                            lever_a * lever_a * rows.a.inertia.inverse_inertia +
                            lever_b * lever_b * rows.b.inertia.inverse_inertia;
    return mobility > 0.0 ? 1.0 / mobility : 0.0;
  };
  rows.normal_lever_a = cross(from_a, point.normal_W);
  rows.normal_lever_b = cross(from_b, point.normal_W);
  rows.normal_mass = mass_of(rows.normal_lever_a, rows.normal_lever_b);
  rows.side_lever_a = cross(from_a, side_W);
  rows.side_lever_b = cross(from_b, side_W);
  rows.side_mass = mass_of(rows.side_lever_a, rows.side_lever_b);

  const Vector3d point_W(point.position_W.x(), point.position_W.y(), z);
  const Vector2d by_joints = (joint_velocity(part_a, point_W) - joint_velocity(part_b, point_W)).head<2>();
  double target = separating_velocity(point.gap, step);
  if (surfaces.restitution > 0.0) {
    const double approach = along(rows.normal_W, rows.normal_lever_b, *rows.b.velocity) -
                            along(rows.normal_W, rows.normal_lever_a, *rows.a.velocity) - rows.normal_W.dot(by_joints);
    if (approach > surfaces.bounce_threshold && approach * step > point.gap)
      target = std::max(target, surfaces.restitution * approach);
  }
  rows.normal_target = target - rows.normal_W.dot(by_joints);
  rows.side_target = -side_W.dot(by_joints);
  rows.normal_impulse = point.normal_impulse;
  // As in the full model, friction between two moving bodies starts from zero, and on the world from its last impulse.
  rows.side_impulse = part_b.member == Anchors::nobody ? point.friction_impulse : 0.0;
}

void PlanarSolver::add_connection(Connection& connection, double step) {
  ConnectionRows& rows = connections_.emplace_back();
  const Connection::End& end_a = connection.a();
  const Connection::End& end_b = connection.b();
  const bool to_world = end_b.member == Anchors::nobody;
  rows.connection = &connection;
  rows.a = side_of(end_a.member);
  rows.b = side_of(end_b.member);
  const Pose X_WPa = bodies_.segment_pose(end_a.member, end_a.segment) * end_a.X_SP;
  const Pose X_WPb = (to_world ? Pose{} : bodies_.segment_pose(end_b.member, end_b.segment)) * end_b.X_SP;
  const Vector3d gap_W = X_WPa.position - X_WPb.position;
  const Vector3d middle_W = 0.5 * (X_WPa.position + X_WPb.position);
  const Eigen::Quaterniond twist = X_WPa.orientation * X_WPb.orientation.conjugate();
  const double turned = (twist.w() < 0.0 ? -2.0 : 2.0) * twist.z();
  rows.target = -correction_share / step * Vector3d(gap_W.x(), gap_W.y(), turned) -
                (joint_velocity({end_a.member, end_a.segment}, middle_W) -
                 joint_velocity({end_b.member, end_b.segment}, middle_W));

  rows.from_a_W = middle_W.head<2>() - rows.a.centre_W;
  rows.from_b_W = middle_W.head<2>() - rows.b.centre_W;
  Matrix3d mobility = Matrix3d::Zero();
  const auto add_mobility = [&](const PlanarInertia& inertia, const Vector2d& from) {
    const Vector3d turning(-from.y(), from.x(), 1.0);
    mobility += inertia.inverse_inertia * turning * turning.transpose();
    mobility(0, 0) += inertia.inverse_mass;
    mobility(1, 1) += inertia.inverse_mass;
  };
  add_mobility(rows.a.inertia, rows.from_a_W);
  add_mobility(rows.b.inertia, rows.from_b_W);
  rows.mass = mobility(0, 0) > 0.0 ? Matrix3d(mobility.inverse()) : Matrix3d(Matrix3d::Zero());
  const std::array<double, 6>& impulses = connection.impulses();
  rows.impulse = {impulses[0], impulses[1], impulses[5]};
}

void PlanarSolver::push(ContactRows& rows, double along_normal, double sideways) {
  const Vector2d impulse = along_normal * rows.normal_W + sideways * left_of(rows.normal_W);
  const auto push_side = [&](Side& side, double sign, double normal_lever, double side_lever) {
    side.velocity->x += sign * side.inertia.inverse_mass * impulse.x();
    side.velocity->y += sign * side.inertia.inverse_mass * impulse.y();
    side.velocity->spin += sign * side.inertia.inverse_inertia * (along_normal * normal_lever + sideways * side_lever);
  };
  push_side(rows.a, 1.0, rows.normal_lever_a, rows.side_lever_a);
  push_side(rows.b, -1.0, rows.normal_lever_b, rows.side_lever_b);
}

void PlanarSolver::push(ConnectionRows& rows, const Vector3d& impulse) {
  const auto push_side = [&](Side& side, double sign, const Vector2d& from) {
    side.velocity->x += sign * side.inertia.inverse_mass * impulse.x();
    side.velocity->y += sign * side.inertia.inverse_mass * impulse.y();
    side.velocity->spin += sign * side.inertia.inverse_inertia * (cross(from, impulse.head<2>()) + impulse.z());
  };
  push_side(rows.a, 1.0, rows.from_a_W);
  push_side(rows.b, -1.0, rows.from_b_W);
}

// Both functions return the greatest change of a velocity.
double PlanarSolver::solve(ContactRows& rows) {
  const Vector2d side_W = left_of(rows.normal_W);
  const double slip =
      along(side_W, rows.side_lever_a, *rows.a.velocity) - along(side_W, rows.side_lever_b, *rows.b.velocity);
  const double limit = rows.friction * rows.normal_impulse;
  const double side_impulse = std::clamp(rows.side_impulse + rows.side_mass * (rows.side_target - slip), -limit, limit);
  const double sideways = side_impulse - rows.side_impulse;
  rows.side_impulse = side_impulse;
  if (sideways != 0.0) push(rows, 0.0, sideways);

  const double approach = along(rows.normal_W, rows.normal_lever_a, *rows.a.velocity) -
                          along(rows.normal_W, rows.normal_lever_b, *rows.b.velocity);
  const double normal_impulse = std::max(0.0, rows.normal_impulse + rows.normal_mass * (rows.normal_target - approach));
  const double along_normal = normal_impulse - rows.normal_impulse;
  rows.normal_impulse = normal_impulse;
  if (along_normal != 0.0) push(rows, along_normal, 0.0);
  return std::max(std::abs(sideways), std::abs(along_normal)) *
         std::max(rows.a.inertia.inverse_mass, rows.b.inertia.inverse_mass);
}

double PlanarSolver::solve(ConnectionRows& rows) {
  const auto velocity_of = [](const Side& side, const Vector2d& from) {
    return Vector3d(side.velocity->x - side.velocity->spin * from.y(),
                    side.velocity->y + side.velocity->spin * from.x(), side.velocity->spin);
  };
  const Vector3d missing = rows.target - velocity_of(rows.a, rows.from_a_W) + velocity_of(rows.b, rows.from_b_W);
  const Vector3d impulse = rows.mass * missing;
  rows.impulse += impulse;
  push(rows, impulse);
  return missing.cwiseAbs().maxCoeff();
}

void PlanarSolver::begin() {
  for (const std::uint32_t member : members_)
    grounds_[member].begin(bodies_.place(member), bodies_.inertia(member), bodies_.velocity(member));
  for (ConnectionRows& rows : connections_) push(rows, rows.impulse);
  for (ContactRows& rows : contacts_) push(rows, rows.normal_impulse, rows.side_impulse);
}

void PlanarSolver::solve(std::uint32_t iterations) {
  begin();
  for (std::uint32_t i = 0; i < iterations; ++i) {
    double change = 0.0;
    for (const std::uint32_t member : members_)
      change = std::max(change, grounds_[member].solve(bodies_.inertia(member), bodies_.velocity(member)));
    // Alternate the direction, so that a pull at one end of a chain reaches the other end within two passes.
    if (i % 2 == 0) {
      for (ConnectionRows& rows : connections_) change = std::max(change, solve(rows));
    } else {
      for (std::size_t j = connections_.size(); j-- > 0;) change = std::max(change, solve(connections_[j]));
    }
    for (ContactRows& rows : contacts_) change = std::max(change, solve(rows));
    if (change < tolerance) break;
  }
}

void PlanarSolver::keep(double step) {
  for (const std::uint32_t member : members_) grounds_[member].finish(bodies_.velocity(member), step);
  for (const ContactRows& rows : contacts_) {
    rows.point->normal_impulse = rows.normal_impulse;
    rows.point->friction_impulse = rows.side_impulse;
  }
  for (const ConnectionRows& rows : connections_) {
    std::array<double, 6>& impulses = rows.connection->impulses();
    impulses[0] = rows.impulse.x();
    impulses[1] = rows.impulse.y();
    impulses[5] = rows.impulse.z();
  }
}

}  // namespace cohort::physics
