// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/connection.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/mechanism/rotation.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

using Eigen::Vector3d;

// Converts the vector back to a rotation, exactly: a connection that does not slip must not creep.
Eigen::Quaterniond rotation_of(const Vector3d& vector) {
  const Vector3d half = 0.5 * vector;
  return {std::sqrt(std::max(0.0, 1.0 - half.squaredNorm())), half.x(), half.y(), half.z()};
}

// Displacement from frame P as b carries it to P as a carries it: translation and rotation vector in world axes.
Vector3d gap(const Pose& X_WPa, const Pose& X_WPb) { return X_WPa.position - X_WPb.position; }
Vector3d twist(const Pose& X_WPa, const Pose& X_WPb) {
  return rotation_vector(X_WPa.orientation * X_WPb.orientation.conjugate());
}

Vector3d linear(const Connection::Impulses& impulses) { return {impulses[0], impulses[1], impulses[2]}; }
Vector3d angular(const Connection::Impulses& impulses) { return {impulses[3], impulses[4], impulses[5]}; }

Connection::Impulses turned(const Eigen::Matrix3d& by, const Connection::Impulses& impulses) {
  const Vector3d first = by * linear(impulses);
  const Vector3d second = by * angular(impulses);
  return {first.x(), first.y(), first.z(), second.x(), second.y(), second.z()};
}

bool is_rigid(const ConnectionGive& give) {
  const auto all_infinite = [](const Vector3d& v) {
    return std::isinf(v.x()) && std::isinf(v.y()) && std::isinf(v.z());
  };
  return std::isinf(give.linear_stiffness) && std::isinf(give.holding_force) && all_infinite(give.angular_stiffness) &&
         all_infinite(give.holding_torque);
}

}  // namespace

void Connection::set_give(const ConnectionGive& give) {
  if (!holds_) return;
  give_ = give;
  yields_ = yields_ || !is_rigid(give);
}

void Connection::release() {
  holds_ = false;
  has_rows_ = false;
  impulses_ = {};
}

void Connection::break_now() {
  breaking_ = impulses_;
  release();
}

Connection::Spring Connection::spring(int axis) const {
  if (axis < 3) return {give_.linear_stiffness, give_.linear_damping, give_.holding_force};
  return {give_.angular_stiffness[axis - 3], give_.angular_damping[axis - 3], give_.holding_torque[axis - 3]};
}

Connection::Errors Connection::errors_at(const Ends& X_WS) const {
  const Pose X_WPa = X_WS.a * a_.X_SP;
  const Pose X_WPb = X_WS.b * b_.X_SP;
  // A compliant one turns with a, and has its errors in the axes of P.
  const Eigen::Quaterniond to_axes = yields_ ? X_WPa.orientation.conjugate() : Eigen::Quaterniond::Identity();
  // `twist` is twice the sine of half the angle. The angle itself, by a series, grows evenly with time.
  const Vector3d sine_W = twist(X_WPa, X_WPb);
  return {to_axes * gap(X_WPa, X_WPb), to_axes * (sine_W * (1.0 + sine_W.squaredNorm() / 24.0))};
}

void Connection::add_rows(Problem& problem, const Anchors& anchors, const Ends& X_WS, const Ends& ahead, double step) {
  const Pose X_WPa = X_WS.a * a_.X_SP;
  point_W_ = 0.5 * (X_WPa.position + (X_WS.b * b_.X_SP).position);
  if (yields_) {
    has_rows_ = true;
    axes_W_ = X_WPa.orientation.toRotationMatrix();
    row_impulses_ = turned(axes_W_.transpose(), impulses_);
  }
  const Anchor a{anchors.index_of_member[a_.member], a_.segment};
  const Anchor b = b_.member == Anchors::nobody ? Anchor{} : Anchor{anchors.index_of_member[b_.member], b_.segment};
  const Errors errors = errors_at(X_WS);
  const Errors errors_ahead = errors_at(ahead);
  for (int axis = 0; axis < 6; ++axis) {
    double& kept = (yields_ ? row_impulses_ : impulses_)[static_cast<std::size_t>(axis)];
    if (yields_ && spring(axis).is_free()) {
      kept = 0.0;
      continue;
    }
    const Vector3d direction_W = yields_ ? Vector3d(axes_W_.col(axis % 3)) : Vector3d::Unit(axis % 3);
    Row& row = axis < 3 ? problem.add_force_row(a, b, point_W_, direction_W, &kept)
                        : problem.add_torque_row(a, b, direction_W, &kept);
    const double off = errors[axis];
    const double by_turning = problem.velocity_by_turning(row, off, errors_ahead[axis], step);
    const double most = axis < 3 ? most_linear_correction : most_angular_correction;
    row.target = correction(correction_share, off, most, step) - by_turning;
    if (yields_) make_yielding(row, spring(axis), off + step * by_turning, step);
  }
}

// A spring k with a damper c, both at the end of the step, exerts f = -k (x + h v) - c v. With the impulse i = h f this
// is a soft row: v + i / (h (h k + c)) = -k x / (h k + c).
void Connection::make_yielding(Row& row, const Spring& spring, double off, double step) {
  row.set_limits(-spring.limit * step, spring.limit * step);
  row.is_hold = true;
  if (std::isinf(spring.stiffness)) return;
  row.target = -spring.stiffness * off / (step * spring.stiffness + spring.damping);
  row.soften(1.0 / (step * (step * spring.stiffness + spring.damping)));
}

void Connection::settle(const Pose& X_WSa, const Pose& X_WSb, double step) {
  if (!has_rows_) return;
  has_rows_ = false;
  impulses_ = turned(axes_W_, row_impulses_);
  // If a row reached its limit, the rest position moves to where the spring gives exactly that force.
  const Pose X_WPa = X_WSa * a_.X_SP;
  const Pose X_WPb = X_WSb * b_.X_SP;
  const Eigen::Matrix3d R = X_WPa.orientation.toRotationMatrix();
  Vector3d gap_P = R.transpose() * gap(X_WPa, X_WPb);
  Vector3d twist_P = R.transpose() * twist(X_WPa, X_WPb);
  bool has_slipped = false;
  for (int axis = 0; axis < 6; ++axis) {
    const auto [stiffness, damping, limit] = spring(axis);
    const double force = row_impulses_[static_cast<std::size_t>(axis)] / step;
    const bool slips = limit == 0.0 || stiffness == 0.0 || std::abs(force) >= limit * (1.0 - 1e-9);
    if (!slips) continue;
    has_slipped = true;
    double& off = axis < 3 ? gap_P[axis] : twist_P[axis - 3];
    const double stretch = std::isinf(stiffness) || stiffness == 0.0 ? 0.0 : -force / stiffness;
    // The rest position never moves beyond the present one: a damper may have taken part of the force.
    off = off * stretch <= 0.0 ? 0.0 : std::copysign(std::min(std::abs(off), std::abs(stretch)), off);
  }
  if (!has_slipped) return;
  const Pose new_X_WPb{X_WPa.position - R * gap_P, (rotation_of(-(R * twist_P)) * X_WPa.orientation).normalized()};
  b_.X_SP = X_WSb.inverse() * new_X_WPb;
}

Wrench Connection::wrench_on_a(const Pose& X_WSa, const Pose& X_WSb, double step) const {
  const Vector3d force_W = linear(last()) / step;
  const Vector3d to_middle_W = -0.5 * gap(X_WSa * a_.X_SP, X_WSb * b_.X_SP);
  return {force_W, angular(last()) / step + to_middle_W.cross(force_W)};
}

Wrench Connection::wrench_on_b(const Pose& X_WSa, const Pose& X_WSb, double step) const {
  const Vector3d force_W = -linear(last()) / step;
  const Vector3d to_middle_W = 0.5 * gap(X_WSa * a_.X_SP, X_WSb * b_.X_SP);
  return {force_W, -angular(last()) / step + to_middle_W.cross(force_W)};
}

bool Connection::is_overloaded(double step) const {
  return linear(impulses_).norm() / step > limits_.force || angular(impulses_).norm() / step > limits_.torque;
}

}  // namespace cohort::physics
