#include "server/physics/multibody/mass_matrix.hpp"

#include <array>

namespace cohort::physics {
namespace {

constexpr int free_dofs = 6;
constexpr int most_inverted = 12;

}  // namespace

void MassMatrix::set_up(const Multibody& body, const std::vector<Spatial>& axes, const Eigen::Vector3d& gravity) {
  body_ = &body;
  mechanism_ = &body.mechanism();
  axes_ = &axes;
  size_ = mechanism_->dof_count();
  stride_ = mechanism_->stride();
  work_.resize(mechanism_->segments().size());
  matrix_.assign(at(size_ * stride_), 0.0);
  bias_.assign(at(size_), 0.0);
  move_outwards(gravity);
  gather_inwards();
}

// Velocities and, with the joints unaccelerated, accelerations from the root to the leaves, and the force that this
// takes of each segment. Gravity is an acceleration of the world upwards.
void MassMatrix::move_outwards(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d reference = body_->reference();
  const double* velocities = body_->velocities();
  const Spatial resting{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Spatial world{Eigen::Vector3d::Zero(), -gravity};
  for (std::size_t s = 0; s < work_.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    const Pose& X_WS = body_->segment_pose(static_cast<int>(s));
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    Work& work = work_[s];
    work.velocity = segment.parent < 0 ? resting : work_[at(segment.parent)].velocity;
    work.acceleration = segment.parent < 0 ? world : work_[at(segment.parent)].acceleration;

    if (segment.motion == Motion::free) {
      work.velocity = {{velocities[0], velocities[1], velocities[2]}, {velocities[3], velocities[4], velocities[5]}};
      // The reference moves along: where its own acceleration is zero, that of the space around it is not.
      work.acceleration.linear -= work.velocity.angular.cross(work.velocity.linear);
    } else {
      Spatial joint = resting;
      for (int i = 0; i < segment.dofs; ++i) {
        const int dof = segment.first_dof + i;
        const Spatial& axis = (*axes_)[at(dof)];
        joint.angular += velocities[dof] * axis.angular;
        joint.linear += velocities[dof] * axis.linear;
      }
      work.velocity.angular += joint.angular;
      work.velocity.linear += joint.linear;
      work.acceleration.angular += work.velocity.angular.cross(joint.angular);
      work.acceleration.linear += work.velocity.angular.cross(joint.linear) + work.velocity.linear.cross(joint.angular);
    }

    const Eigen::Vector3d arm = X_WS.position + R * segment.centre_S - reference;
    work.mass = segment.mass;
    work.moment = segment.mass * arm;
    work.inertia = R * segment.inertia_S * R.transpose();
    work.inertia += segment.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());

    const Spatial& v = work.velocity;
    const Spatial& a = work.acceleration;
    const Eigen::Vector3d angular_momentum = work.inertia * v.angular + work.moment.cross(v.linear);
    const Eigen::Vector3d linear_momentum = work.mass * v.linear - work.moment.cross(v.angular);
    // That of a body on its own is left to how it moves on: Multibody::integrate.
    const Eigen::Vector3d gyroscopic =
        mechanism_->is_free_body() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(v.angular.cross(angular_momentum));
    work.force.angular =
        work.inertia * a.angular + work.moment.cross(a.linear) + gyroscopic + v.linear.cross(linear_momentum);
    work.force.linear = work.mass * a.linear - work.moment.cross(a.angular) + v.angular.cross(linear_momentum);
  }
}

// Forces and inertias from the leaves to the root: the bias force of each dof and its row of the mass matrix.
void MassMatrix::gather_inwards() {
  for (std::size_t s = work_.size(); s-- > 0;) {
    const Segment& segment = mechanism_->segments()[s];
    const Work& work = work_[s];
    if (segment.motion == Motion::free) {
      take_free_root(work);
    } else {
      for (int i = segment.first_dof; i < segment.first_dof + segment.dofs; ++i) take_joint(i, work);
    }
    if (segment.parent < 0) continue;
    Work& parent = work_[at(segment.parent)];
    parent.force.angular += work.force.angular;
    parent.force.linear += work.force.linear;
    parent.inertia += work.inertia;
    parent.moment += work.moment;
    parent.mass += work.mass;
  }
}

void MassMatrix::take_free_root(const Work& whole) {
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
  for (int i = 0; i < 3; ++i) {
    bias_[at(i)] = whole.force.angular[i];
    bias_[at(3 + i)] = whole.force.linear[i];
  }
}

// `beyond`: the joint's segment with all that hangs on it.
void MassMatrix::take_joint(int dof, const Work& beyond) {
  const Spatial& axis = (*axes_)[at(dof)];
  bias_[at(dof)] = axis.angular.dot(beyond.force.angular) + axis.linear.dot(beyond.force.linear);
  const Spatial momentum{beyond.inertia * axis.angular + beyond.moment.cross(axis.linear),
                         beyond.mass * axis.linear - beyond.moment.cross(axis.angular)};
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
    row_k[k] = inverse;  // the solver multiplies
  }
}

// From the factors: inv(L) inv(D) inv(L)', row by row.
bool MassMatrix::is_small() const { return size_ <= most_inverted; }

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
