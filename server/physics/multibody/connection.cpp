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

void Connection::add_rows(Problem& problem, const Anchors& anchors, const Pose& X_WSa, const Pose& X_WSb, double step) {
  const Pose X_WPa = X_WSa * a_.X_SP;
  const Pose X_WPb = X_WSb * b_.X_SP;
  const Anchor a{anchors.index_of_member[a_.member], a_.segment};
  const Anchor b = b_.member == Anchors::nobody ? Anchor{} : Anchor{anchors.index_of_member[b_.member], b_.segment};
  point_W_ = 0.5 * (X_WPa.position + X_WPb.position);
  if (yields_) return add_yielding_rows(problem, a, b, X_WPa, X_WPb, step);
  const Vector3d gap_W = gap(X_WPa, X_WPb);
  const Vector3d twist_W = twist(X_WPa, X_WPb);
  for (int axis = 0; axis < 3; ++axis) {
    double* kept = &impulses_[static_cast<std::size_t>(axis)];
    problem.add_force_row(a, b, point_W_, Vector3d::Unit(axis), kept).target =
        correction(gap_W[axis], most_linear_correction, step);
  }
  for (int axis = 0; axis < 3; ++axis) {
    double* kept = &impulses_[3 + static_cast<std::size_t>(axis)];
    problem.add_torque_row(a, b, Vector3d::Unit(axis), kept).target =
        correction(twist_W[axis], most_angular_correction, step);
  }
}

// Adds rows along the axes of P. A spring k with a damper c, both at the end of the step, exerts f = -k (x + h v) - c
// v. With the impulse i = h f this is a soft row: v + i / (h (h k + c)) = -k x / (h k + c).
void Connection::add_yielding_rows(Problem& problem, Anchor a, Anchor b, const Pose& X_WPa, const Pose& X_WPb,
                                   double step) {
  has_rows_ = true;
  axes_W_ = X_WPa.orientation.toRotationMatrix();
  row_impulses_ = turned(axes_W_.transpose(), impulses_);
  const Vector3d gap_P = axes_W_.transpose() * gap(X_WPa, X_WPb);
  const Vector3d twist_P = axes_W_.transpose() * twist(X_WPa, X_WPb);
  for (int axis = 0; axis < 6; ++axis) {
    double& kept = row_impulses_[static_cast<std::size_t>(axis)];
    const auto [stiffness, damping, limit] = spring(axis);
    const bool is_free = limit == 0.0 || (stiffness == 0.0 && damping == 0.0);
    if (is_free) {
      kept = 0.0;
      continue;
    }
    const Vector3d direction_W = axes_W_.col(axis % 3);
    Row& row = axis < 3 ? problem.add_force_row(a, b, point_W_, direction_W, &kept)
                        : problem.add_torque_row(a, b, direction_W, &kept);
    const double off = axis < 3 ? gap_P[axis] : twist_P[axis - 3];
    row.set_limits(-limit * step, limit * step);
    row.is_hold = true;
    if (std::isinf(stiffness)) {
      row.target = correction(off, axis < 3 ? most_linear_correction : most_angular_correction, step);
    } else {
      row.target = -stiffness * off / (step * stiffness + damping);
      row.soften(1.0 / (step * (step * stiffness + damping)));
    }
  }
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
