#include "server/physics/multibody/equations.hpp"

#include <algorithm>
#include <array>

namespace cohort::physics {
namespace {

constexpr int free_dofs = 6;

std::size_t at(std::ptrdiff_t index) { return static_cast<std::size_t>(index); }

// Up to this many dofs the inverse of the mass matrix is cheaper to have than to do without.
constexpr int most_inverted = 12;

}  // namespace

void Equations::set_up(const Multibody& body, const Eigen::Vector3d& gravity, double step) {
  body_ = &body;
  mechanism_ = &body.mechanism();
  size_ = mechanism_->dof_count();
  stride_ = mechanism_->stride();
  work_.resize(mechanism_->segments().size());
  axes_.resize(at(size_));
  matrix_.assign(at(size_ * stride_), 0.0);
  bias_.assign(at(stride_), 0.0);
  velocity_.assign(at(stride_), 0.0);

  move_outwards(gravity);
  gather_inwards();

  const double* velocities = body.velocities();
  for (int i = 0; i < size_; ++i) {
    const Dof& dof = mechanism_->dofs()[at(i)];
    const double stiffness = dof.axis.spring_stiffness;
    double force = -bias_[at(i)] - dof.axis.damping * velocities[i];
    matrix_[at(i * stride_ + i)] += dof.rotor_inertia + step * dof.axis.damping;
    if (stiffness != 0.0 && dof.coordinate >= 0) {
      const double stretch = body.coordinates()[dof.coordinate] - dof.axis.spring_reference;
      force -= stiffness * (stretch + step * velocities[i]);
      matrix_[at(i * stride_ + i)] += step * step * stiffness;
    }
    velocity_[at(i)] = step * force;
  }
  factorise();
  solve(velocity_.data());
  is_inverted_ = size_ <= most_inverted;
  if (is_inverted_) invert();
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += velocities[i];
}

// Velocities and, with the joints unaccelerated, accelerations from the root to the leaves, and the force that this
// takes of each segment. Gravity is an acceleration of the world upwards.
void Equations::move_outwards(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d& reference = body_->reference();
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
        Spatial& axis = axes_[at(dof)];
        const Eigen::Vector3d direction =
            segment.motion == Motion::ball ? Eigen::Vector3d(R.col(i)) : Eigen::Vector3d(R * segment.axis_S);
        if (segment.motion == Motion::prismatic) {
          axis = {Eigen::Vector3d::Zero(), direction};
        } else {
          axis = {direction, direction.cross(reference - X_WS.position)};
        }
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
void Equations::gather_inwards() {
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

void Equations::take_free_root(const Work& whole) {
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
void Equations::take_joint(int dof, const Work& beyond) {
  const Spatial& axis = axes_[at(dof)];
  bias_[at(dof)] = axis.angular.dot(beyond.force.angular) + axis.linear.dot(beyond.force.linear);
  const Spatial momentum{beyond.inertia * axis.angular + beyond.moment.cross(axis.linear),
                         beyond.mass * axis.linear - beyond.moment.cross(axis.angular)};
  double* row = matrix_.data() + dof * stride_;
  int j = dof;
  for (; j >= 0 && !(mechanism_->has_free_root() && j < free_dofs); j = mechanism_->parents()[at(j)])
    row[j] = axes_[at(j)].angular.dot(momentum.angular) + axes_[at(j)].linear.dot(momentum.linear);
  if (j < 0) return;
  for (int k = 0; k < 3; ++k) {
    row[k] = momentum.angular[k];
    row[3 + k] = momentum.linear[k];
  }
}

void Equations::factorise() {
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
void Equations::invert() {
  inverse_.assign(at(size_ * stride_), 0.0);
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
      inverse_[at(i * stride_ + j)] = inverse_[at(j * stride_ + i)] = value;
    }
  }
}

void Equations::solve(double* x) const {
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

void Equations::add_generalised(int segment, const Spatial& force, double* jacobian) const {
  int i = mechanism_->segments()[at(segment)].last_dof;
  for (; i >= 0 && !(mechanism_->has_free_root() && i < free_dofs); i = mechanism_->parents()[at(i)])
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

void Equations::respond(const double* jacobian, double* response) const {
  if (!is_inverted_) {
    std::copy_n(jacobian, stride_, response);
    solve(response);
    return;
  }
  std::fill_n(response, stride_, 0.0);
  for (int i = 0; i < size_; ++i)
    if (jacobian[i] != 0.0) add_scaled(jacobian[i], inverse_.data() + i * stride_, response, stride_);
}

void Equations::push(int segment, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
                     const Eigen::Vector3d& angular_impulse_W) {
  std::vector<double> generalised(at(stride_), 0.0);
  std::vector<double> response(at(stride_), 0.0);
  add_force(segment, point_W, impulse_W, generalised.data());
  add_torque(segment, angular_impulse_W, generalised.data());
  respond(generalised.data(), response.data());
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += response[at(i)];
}

void Equations::push_dof(int dof, double impulse) {
  std::vector<double> generalised(at(stride_), 0.0);
  std::vector<double> response(at(stride_), 0.0);
  generalised[at(dof)] = impulse;
  respond(generalised.data(), response.data());
  for (int i = 0; i < size_; ++i) velocity_[at(i)] += response[at(i)];
}

}  // namespace cohort::physics
