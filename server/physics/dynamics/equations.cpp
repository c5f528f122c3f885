// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/equations.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "server/physics/dynamics/gyroscopic.hpp"

namespace cohort::physics {
namespace {

constexpr int free_root_dofs = 6;
// Greatest number of degrees of freedom for which symmetric equations are solved by the mass matrix. Beyond it, the
// recursion is faster for chains: from 36 degrees of freedom with ball joints and 52 with hinges. With four limbs, it
// is faster from 75 and 105.
constexpr int most_by_matrix = 64;

}  // namespace

void Equations::set_up(const BodyMotion& body, const Eigen::Vector3d& gravity, double step, bool is_held) {
  body_ = &body;
  mechanism_ = &body.mechanism();
  size_ = mechanism_->dof_count();
  stride_ = mechanism_->stride();
  velocity_.assign(at(stride_), 0.0);
  pushed_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  find_joint_axes(body, axes_);
  bool has_mass = false;
  is_symmetric_ = !has_stiff_gyroscopic_torques(body, step, is_held, [&]() -> const MassMatrix& {
    if (has_mass) return matrix_;
    has_mass = true;
    bias_.set_up(*body_, axes_);
    matrix_.set_up(*body_, axes_, bias_);
    matrix_.factorise();
    return matrix_;
  });
  is_recursive_ = !is_symmetric_ || size_ > most_by_matrix;
  const bool is_bullet = body.bullet() != nullptr;
  const bool has_springs = std::ranges::any_of(mechanism_->dofs(), [](const Dof& dof) { return dof.has_spring(); });
  const bool has_matrix = has_springs || !(is_recursive_ || (is_bullet && MassMatrix::is_small(size_)));
  if (has_matrix || is_recursive_ || !is_bullet) bias_.set_up(*body_, axes_);
  if (has_matrix) matrix_.set_up(*body_, axes_, bias_);
  find_efforts(step);
  if (is_recursive_) {
    solve_by_recursion(gravity, step);
  } else {
    is_bullet ? solve_by_bullet(gravity, step) : solve_by_mass_matrix(gravity, step);
  }
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += body.velocities()[i];
}

// Replaces the bias forces of the beginning of the step by those of its middle if parts spin fast. These neither add
// nor remove energy. The two differ by half the velocity change times the derivative of the bias force; this also holds
// for changes by impulses.
//
// Bullet knows neither this nor the added inertia: the change of the velocities that it misses is computed here.
void Equations::solve_by_recursion(const Eigen::Vector3d& gravity, double step) {
  const double half_step = is_symmetric_ ? 0.0 : 0.5 * step;
  articulated_.set_up(*body_, added_inertia_, half_step);
  if (body_->bullet() != nullptr) {
    body_->bullet()->solve(body_->segment_poses(), gravity, efforts_.data(), step, velocity_.data(), nullptr);
    response_.assign(at(stride_), 0.0);
    if (!is_symmetric_) find_growth(velocity_.data(), response_.data());
    for (int i = 0; i < size_; ++i)
      response_[at(i)] = -half_step * response_[at(i)] - added_inertia_[at(i)] * velocity_[at(i)];
    articulated_.solve(response_.data());
    add_scaled(1.0, response_.data(), velocity_.data(), stride_);
  } else {
    bias_.find(body_->velocities(), gravity, velocity_.data());
    for (int i = 0; i < size_; ++i) velocity_[at(i)] = step * (-velocity_[at(i)] + efforts_[at(i)]);
    articulated_.solve(velocity_.data());
  }
  is_inverted_ = false;
}

// Computes the growth of the bias forces by a change of the velocities. The bias force is quadratic in the velocities,
// so that the central difference is the exact derivative. It loses the fewest digits if the velocities change by about
// their own size.
void Equations::find_growth(const double* change, double* growth) {
  shifted_.resize(at(stride_));
  opposite_.resize(at(stride_));
  const double* velocities = body_->velocities();
  const auto square = [&](const double* values) { return std::inner_product(values, values + size_, values, 0.0); };
  if (square(change) == 0.0) {
    std::fill_n(growth, size_, 0.0);
    return;
  }
  const double scale = std::sqrt(square(velocities) / square(change));
  for (int i = 0; i < size_; ++i) shifted_[at(i)] = velocities[i] + scale * change[i];
  bias_.find(shifted_.data(), Eigen::Vector3d::Zero(), growth);
  for (int i = 0; i < size_; ++i) shifted_[at(i)] = velocities[i] - scale * change[i];
  bias_.find(shifted_.data(), Eigen::Vector3d::Zero(), opposite_.data());
  for (int i = 0; i < size_; ++i) growth[i] = 0.5 * (growth[i] - opposite_[at(i)]) / scale;
}

// Computes the efforts of dampers and springs. The part that depends on the motion within this step acts like added
// inertia.
//
// The force of a spring is that at the beginning of the step, less a quarter of what the change of the velocity adds to
// its stretch. This neither adds nor removes energy at any step, and oscillates as by the trapezoidal rule. Source:
// Newmark, "A method of computation for structural dynamics", Journal of the Engineering Mechanics Division 85, 1959,
// with beta = 1/4. A spring that the steps cannot follow becomes implicit instead, which brings it to rest.
void Equations::find_efforts(double step) {
  efforts_.assign(at(size_), 0.0);
  added_inertia_.assign(at(size_), 0.0);
  const double* velocities = body_->velocities();
  for (int i = 0; i < size_; ++i) {
    const Dof& dof = mechanism_->dofs()[at(i)];
    const double stiffness = dof.axis.spring_stiffness;
    efforts_[at(i)] = -dof.axis.damping * velocities[i];
    added_inertia_[at(i)] = dof.rotor_inertia + step * dof.axis.damping;
    if (!dof.has_spring()) continue;
    const double stretch = body_->coordinate(dof) - dof.axis.spring_reference;
    const double kept = std::min(1.0, fastest_spring * matrix_.inertia(i) / (step * step * stiffness));
    efforts_[at(i)] -= stiffness * (stretch + (1.0 - kept) * step * velocities[i]);
    added_inertia_[at(i)] += (1.0 - 0.75 * kept) * step * step * stiffness;
  }
}

void Equations::solve_by_mass_matrix(const Eigen::Vector3d& gravity, double step) {
  bias_.find(body_->velocities(), gravity, velocity_.data());
  for (int i = 0; i < size_; ++i) {
    matrix_.add_inertia(i, added_inertia_[at(i)]);
    velocity_[at(i)] = step * (-velocity_[at(i)] + efforts_[at(i)]);
  }
  matrix_.factorise();
  matrix_.solve(velocity_.data());
  is_inverted_ = MassMatrix::is_small(size_);
  if (!is_inverted_) return;
  inverse_.assign(at(size_ * stride_), 0.0);
  matrix_.invert(inverse_.data());
}

// Bullet does not know the added inertia; each term of it is a rank-one update of the inverse. Source: Sherman and
// Morrison, "Adjustment of an inverse matrix corresponding to a change in one element of a given matrix", Annals of
// Mathematical Statistics 21, 1950.
//
// Bullet computes one response at a time, each at nearly the cost of a whole step. A body with many joints therefore
// uses the responses of the mass matrix.
void Equations::solve_by_bullet(const Eigen::Vector3d& gravity, double step) {
  if (!MassMatrix::is_small(size_)) {
    body_->bullet()->solve(body_->segment_poses(), gravity, efforts_.data(), step, velocity_.data(), nullptr);
    response_.assign(at(stride_), 0.0);
    for (int i = 0; i < size_; ++i) {
      matrix_.add_inertia(i, added_inertia_[at(i)]);
      response_[at(i)] = -added_inertia_[at(i)] * velocity_[at(i)];
    }
    matrix_.factorise();
    matrix_.solve(response_.data());
    add_scaled(1.0, response_.data(), velocity_.data(), stride_);
    is_inverted_ = false;
    return;
  }
  inverse_.assign(at(size_ * stride_), 0.0);
  is_inverted_ = true;
  body_->bullet()->solve(body_->segment_poses(), gravity, efforts_.data(), step, velocity_.data(), inverse_.data());
  for (int i = 0; i < size_; ++i) {
    if (added_inertia_[at(i)] == 0.0) continue;
    response_.assign(inverse_.begin() + i * stride_, inverse_.begin() + (i + 1) * stride_);
    const double share = -added_inertia_[at(i)] / (1.0 + added_inertia_[at(i)] * response_[at(i)]);
    add_scaled(share * velocity_[at(i)], response_.data(), velocity_.data(), stride_);
    for (int j = 0; j < size_; ++j) {
      double* of_j = inverse_.data() + j * stride_;
      if (of_j[i] != 0.0) add_scaled(share * of_j[i], response_.data(), of_j, stride_);
    }
  }
}

void Equations::add_generalised(int segment, const Spatial& force, double* jacobian) const {
  int i = mechanism_->segments()[at(segment)].last_dof;
  for (; i >= 0 && !(mechanism_->has_free_root() && i < free_root_dofs); i = mechanism_->parents()[at(i)])
    jacobian[i] += axes_[at(i)].angular.dot(force.angular) + axes_[at(i)].linear.dot(force.linear);
  if (i < 0) return;
  for (int k = 0; k < 3; ++k) {
    jacobian[k] += force.angular[k];
    jacobian[3 + k] += force.linear[k];
  }
}

void Equations::add_force(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                          double* jacobian) const {
  add_generalised(segment, {(point_W - body_->reference()).cross(direction_W), direction_W}, jacobian);
}

void Equations::add_torque(int segment, const Eigen::Vector3d& direction_W, double* jacobian) const {
  add_generalised(segment, {direction_W, Eigen::Vector3d::Zero()}, jacobian);
}

void Equations::respond(const double* jacobian, double* response) {
  if (!is_inverted_) {
    std::copy_n(jacobian, stride_, response);
    is_recursive_ ? articulated_.solve(response) : matrix_.solve(response);
    return;
  }
  std::fill_n(response, stride_, 0.0);
  for (int i = 0; i < size_; ++i)
    if (jacobian[i] != 0.0) add_scaled(jacobian[i], inverse_.data() + i * stride_, response, stride_);
}

void Equations::add_inertia(double* matrix) const {
  if (is_recursive_) {
    MassMatrix inertia;
    inertia.set_up(*body_, axes_, bias_);
    for (int i = 0; i < size_; ++i) inertia.add_inertia(i, added_inertia_[at(i)]);
    inertia.factorise();
    inertia.add_product(matrix);
    return;
  }
  if (body_->bullet() == nullptr || !MassMatrix::is_small(size_)) {
    matrix_.add_product(matrix);
    return;
  }
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, MassMatrix::most_inverted,
                              MassMatrix::most_inverted>;
  Small inverse(size_, size_);
  for (int i = 0; i < size_; ++i)
    for (int j = 0; j < size_; ++j) inverse(i, j) = inverse_[at(i * stride_ + j)];
  const Small inertia = inverse.llt().solve(Small::Identity(size_, size_));
  for (int i = 0; i < size_; ++i)
    for (int j = 0; j < size_; ++j) matrix[i * stride_ + j] += inertia(i, j);
}

void Equations::push(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
                     const Eigen::Vector3d& angular_impulse_W) {
  std::vector<double> generalised(at(stride_), 0.0);
  std::vector<double> response(at(stride_), 0.0);
  add_force(segment, point_W, impulse_W, generalised.data());
  add_torque(segment, angular_impulse_W, generalised.data());
  respond(generalised.data(), response.data());
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += response[at(i)];
  count_push(point_W, {angular_impulse_W, impulse_W});
}

void Equations::push_dof(int dof, double impulse) {
  std::vector<double> generalised(at(stride_), 0.0);
  std::vector<double> response(at(stride_), 0.0);
  generalised[at(dof)] = impulse;
  respond(generalised.data(), response.data());
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += response[at(i)];
}

}  // namespace cohort::physics
