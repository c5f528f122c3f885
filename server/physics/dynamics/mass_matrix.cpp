// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/mass_matrix.hpp"

#include <array>
#include <cassert>

namespace cohort::physics {
namespace {

constexpr int free_dofs = 6;

}  // namespace

void MassMatrix::set_up(const BodyMotion& body, const std::vector<Spatial>& axes, const BiasForces& segments) {
  mechanism_ = &body.mechanism();
  axes_ = &axes;
  size_ = mechanism_->dof_count();
  stride_ = mechanism_->stride();
  matrix_.assign(at(size_ * stride_), 0.0);
  composite_ = segments.inertias();
  added_mass_ = segments.added_masses();
  gather_inwards();
}

// Sums composite inertias from the leaves to the root.
void MassMatrix::gather_inwards() {
  for (std::size_t s = composite_.size(); s-- > 0;) {
    const Segment& segment = mechanism_->segments()[s];
    const SpatialInertia& beyond = composite_[s];
    const SpatialMatrix* const added_mass = added_mass_.empty() ? nullptr : &added_mass_[s];
    if (segment.motion == Motion::free) {
      take_free_root(beyond);
      if (added_mass != nullptr) {
        for (int i = 0; i < free_dofs; ++i)
          for (int j = 0; j <= i; ++j) matrix_[at(i * stride_ + j)] += (*added_mass)(i, j);
      }
    } else {
      for (int i = segment.first_dof; i < segment.first_dof + segment.dofs; ++i) take_joint(i, beyond, added_mass);
    }
    if (segment.parent < 0) continue;
    if (added_mass != nullptr) added_mass_[at(segment.parent)] += *added_mass;
    SpatialInertia& parent = composite_[at(segment.parent)];
    parent.inertia += beyond.inertia;
    parent.moment += beyond.moment;
    parent.mass += beyond.mass;
  }
}

void MassMatrix::take_free_root(const SpatialInertia& whole) {
  const Eigen::Vector3d& h = whole.moment;
  double* m = matrix_.data();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) m[i * stride_ + j] = whole.inertia(i, j);
  for (int i = 3; i < free_dofs; ++i) m[i * stride_ + i] = whole.mass;
  m[3 * stride_ + 1] = h.z();
  m[3 * stride_ + 2] = -h.y();
  m[4 * stride_ + 0] = -h.z();
  m[4 * stride_ + 2] = h.x();
  m[5 * stride_ + 0] = h.y();
  m[5 * stride_ + 1] = -h.x();
}

// `beyond`: the composite inertia of the joint's segment and everything it carries.
void MassMatrix::take_joint(int dof, const SpatialInertia& beyond, const SpatialMatrix* added_mass) {
  const Spatial& axis = (*axes_)[at(dof)];
  Spatial momentum{beyond.inertia * axis.angular + beyond.moment.cross(axis.linear),
                   beyond.mass * axis.linear - beyond.moment.cross(axis.angular)};
  if (added_mass != nullptr) {
    momentum.angular +=
        added_mass->leftCols<3>().topRows<3>() * axis.angular + added_mass->rightCols<3>().topRows<3>() * axis.linear;
    momentum.linear += added_mass->leftCols<3>().bottomRows<3>() * axis.angular +
                       added_mass->rightCols<3>().bottomRows<3>() * axis.linear;
  }
  double* row = matrix_.data() + dof * stride_;
  int j = dof;
  for (; j >= 0 && !(mechanism_->has_free_root() && j < free_dofs); j = mechanism_->parents()[at(j)])
    row[j] = (*axes_)[at(j)].angular.dot(momentum.angular) + (*axes_)[at(j)].linear.dot(momentum.linear);
  if (j < 0) return;
  for (int k = 0; k < 3; ++k) {
    row[k] = momentum.angular[k];
    row[3 + k] = momentum.linear[k];
  }
}

void MassMatrix::factorise() {
  const std::vector<int>& parents = mechanism_->parents();
  for (int k = size_ - 1; k >= 0; --k) {
    double* row_k = matrix_.data() + k * stride_;
    assert(row_k[k] != 0.0);
    const double inverse = 1.0 / row_k[k];
    for (int i = parents[at(k)]; i >= 0; i = parents[at(i)]) {
      double* row_i = matrix_.data() + i * stride_;
      const double factor = row_k[i] * inverse;
      if (mechanism_->is_chain()) {
        for (int j = 0; j <= i; ++j) row_i[j] -= factor * row_k[j];
      } else {
        for (int j = i; j >= 0; j = parents[at(j)]) row_i[j] -= factor * row_k[j];
      }
      row_k[i] = factor;
    }
    row_k[k] = inverse;  // stored as inverse: `solve` multiplies
  }
}

void MassMatrix::add_product(double* matrix) const {
  const std::vector<int>& parents = mechanism_->parents();
  for (int k = 0; k < size_; ++k) {
    const double* row = matrix_.data() + k * stride_;
    const double scale = 1.0 / row[k];
    const auto factor = [&](int i) { return i == k ? 1.0 : row[i]; };
    for (int i = k; i >= 0; i = parents[at(i)])
      for (int j = k; j >= 0; j = parents[at(j)]) matrix[i * stride_ + j] += factor(i) * scale * factor(j);
  }
}

// The inverse is computed from the factors, inv(L) inv(D) inv(L)', row by row.
void MassMatrix::invert(double* inverse) const {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only its lower triangle is ever read.
  std::array<std::array<double, most_inverted>, most_inverted> inverse_l;
  for (int i = 0; i < size_; ++i) {
    const double* row = matrix_.data() + i * stride_;
    for (int j = 0; j < i; ++j) {
      double value = -row[j];
      for (int k = j + 1; k < i; ++k) value -= row[k] * inverse_l[at(k)][at(j)];
      inverse_l[at(i)][at(j)] = value;
    }
    inverse_l[at(i)][at(i)] = 1.0;
  }
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j <= i; ++j) {
      double value = 0.0;
      for (int k = 0; k <= j; ++k)
        value += inverse_l[at(i)][at(k)] * matrix_[at(k * stride_ + k)] * inverse_l[at(j)][at(k)];
      inverse[i * stride_ + j] = inverse[j * stride_ + i] = value;
    }
  }
}

void MassMatrix::solve(double* x) const {
  const std::vector<int>& parents = mechanism_->parents();
  const double* row = matrix_.data() + (size_ - 1) * stride_;
  for (int i = size_ - 1; i > 0; --i, row -= stride_)
    for (int j = parents[at(i)]; j >= 0; j = parents[at(j)]) x[j] -= row[j] * x[i];
  for (int i = 0; i < size_; ++i, row += stride_) {
    double value = x[i] * row[i];
    for (int j = parents[at(i)]; j >= 0; j = parents[at(j)]) value -= row[j] * x[j];
    x[i] = value;
  }
}

}  // namespace cohort::physics
