#include "server/physics/connection.hpp"

namespace cohort::physics {
namespace {

constexpr double correction_share = 0.2;  // of a gap or a twist, taken away by one step

// The rotation vector of a small rotation.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) { return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec(); }

}  // namespace

void Connection::release() {
  holds_ = false;
  impulses_ = {};
}

void Connection::add_rows(Problem& problem, const Anchors& anchors, const Pose& X_WSa, const Pose& X_WSb, double step) {
  const Pose X_WPa = X_WSa * a_.X_SP;
  const Pose X_WPb = X_WSb * b_.X_SP;
  const Anchor a{anchors.index_of_member[a_.member], a_.segment};
  const Anchor b = b_.member == Anchors::nobody ? Anchor{} : Anchor{anchors.index_of_member[b_.member], b_.segment};
  const Eigen::Vector3d gap_W = X_WPa.position - X_WPb.position;
  const Eigen::Vector3d twist_W = rotation_vector(X_WPa.orientation * X_WPb.orientation.conjugate());
  const Eigen::Vector3d middle_W = 0.5 * (X_WPa.position + X_WPb.position);
  for (int axis = 0; axis < 3; ++axis) {
    double* kept = &impulses_[static_cast<std::size_t>(axis)];
    problem.add_force_row(a, b, middle_W, Eigen::Vector3d::Unit(axis), kept).target =
        -correction_share * gap_W[axis] / step;
  }
  for (int axis = 0; axis < 3; ++axis) {
    double* kept = &impulses_[3 + static_cast<std::size_t>(axis)];
    problem.add_torque_row(a, b, Eigen::Vector3d::Unit(axis), kept).target = -correction_share * twist_W[axis] / step;
  }
}

Wrench Connection::wrench(double step) const {
  return {Eigen::Vector3d(impulses_[0], impulses_[1], impulses_[2]) / step,
          Eigen::Vector3d(impulses_[3], impulses_[4], impulses_[5]) / step};
}

bool Connection::is_overloaded(double step) const {
  const Wrench load = wrench(step);
  return load.force_W.norm() > limits_.force || load.torque_W.norm() > limits_.torque;
}

}  // namespace cohort::physics
