#include "server/physics/multibody.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

namespace cohort::physics {
namespace {

struct PrincipalInertia {
  Eigen::Vector3d moments;
  Eigen::Quaterniond q_IB;  // the principal axes in the inertial frame
};

PrincipalInertia principal(const Eigen::Matrix3d& inertia) {
  if (inertia.isDiagonal(0.0)) return {inertia.diagonal(), Eigen::Quaterniond::Identity()};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return {solver.eigenvalues(), Eigen::Quaterniond(axes)};
}

}  // namespace

Multibody::Multibody(const description::Model& model, const Pose& X_WM, std::uint32_t body,
                     const geometry::Scene& scene)
    : model_(&model), body_(body), handle_(nullptr, -1) {
  build_links(X_WM);
  handle_.m_multiBody = multibody_.get();
  multibody_->setBaseCollider(&handle_);
  build_devices(scene);
}

void Multibody::build_links(const Pose& X_WM) {
  const std::vector<description::Link>& links = model_->links;
  std::vector<btVector3> moments;
  for (const description::Link& link : links) {
    const PrincipalInertia inertia = principal(link.inertial.inertia);
    X_LB_.push_back(link.inertial.X_LI * Pose{Eigen::Vector3d::Zero(), inertia.q_IB});
    moments.push_back(to_bullet(inertia.moments));
  }
  const auto X_MB = [&](std::size_t link) { return links[link].X_ML * X_LB_[link]; };

  const bool fixed_base = false;
  const bool can_sleep = false;
  multibody_ = std::make_unique<btMultiBody>(static_cast<int>(links.size()) - 1, links[0].inertial.mass, moments[0],
                                             fixed_base, can_sleep);
  multibody_->setLinearDamping(0.0);
  multibody_->setAngularDamping(0.0);
  multibody_->setHasSelfCollision(false);
  multibody_->setUseGyroTerm(true);
  multibody_->setMaxCoordinateVelocity(1000.0);

  for (const description::Joint& joint : model_->joints) {
    const Pose X_BL_child = X_LB_[joint.child].inverse();
    const Pose X_BpB = X_MB(joint.parent).inverse() * X_MB(joint.child);
    const Eigen::Vector3d pivot_B = X_BL_child * joint.X_LJ.position;
    const Eigen::Vector3d axis_B = X_BL_child.orientation * (joint.X_LJ.orientation * joint.axis.direction);
    const int link = bullet_link(joint.child);
    const int parent = bullet_link(joint.parent);
    const double mass = links[joint.child].inertial.mass;
    const btVector3& inertia = moments[joint.child];
    const btQuaternion parent_to_child = to_bullet(X_BpB.orientation.conjugate());
    const btVector3 parent_to_pivot = to_bullet(X_BpB * pivot_B);
    const btVector3 pivot_to_child = to_bullet(-pivot_B);
    switch (joint.type) {
      case description::JointType::fixed:
        multibody_->setupFixed(link, mass, inertia, parent, parent_to_child, parent_to_pivot, pivot_to_child);
        break;
      case description::JointType::revolute:
        multibody_->setupRevolute(link, mass, inertia, parent, parent_to_child, to_bullet(axis_B), parent_to_pivot,
                                  pivot_to_child, true);
        break;
      case description::JointType::prismatic:
        multibody_->setupPrismatic(link, mass, inertia, parent, parent_to_child, to_bullet(axis_B), parent_to_pivot,
                                   pivot_to_child, true);
        break;
      case description::JointType::ball:
      case description::JointType::universal:
        throw std::invalid_argument("joint '" + joint.name + "' is of a type that is not simulated");
    }
  }
  multibody_->finalizeMultiDof();

  const Pose X_WB = X_WM * X_MB(0);
  multibody_->setBasePos(to_bullet(X_WB.position));
  multibody_->setWorldToBaseRot(to_bullet(X_WB.orientation.conjugate()));
  Scratch scratch;
  multibody_->forwardKinematics(scratch.rotations, scratch.vectors);
}

void Multibody::build_devices(const geometry::Scene& scene) {
  motors_.resize(model_->joints.size());
  drives_.resize(model_->devices.size());
  for (const description::Joint& joint : model_->joints) {
    if (joint.type == description::JointType::fixed || !(std::isfinite(joint.axis.lower) || std::isfinite(joint.axis.upper)))
      continue;
    limits_.push_back(
        std::make_unique<JointLimit>(multibody_.get(), bullet_link(joint.child), joint.axis.lower, joint.axis.upper));
    constraints_.push_back(limits_.back().get());
  }
  for (std::size_t device = 0; device < model_->devices.size(); ++device) {
    if (const auto* motor = std::get_if<description::VelocityMotor>(&model_->devices[device])) {
      const description::Joint& joint = model_->joints[motor->joint];
      if (joint.type == description::JointType::fixed)
        throw std::invalid_argument("motor '" + motor->name + "' drives the fixed joint '" + joint.name + "'");
      if (motors_[motor->joint])
        throw std::invalid_argument("motor '" + motor->name + "' drives the joint '" + joint.name +
                                    "', which has a motor already");
      motors_[motor->joint] =
          std::make_unique<JointMotor>(multibody_.get(), bullet_link(joint.child), motor->max_effort);
      constraints_.push_back(motors_[motor->joint].get());
    } else if (const auto* drive = std::get_if<description::TreelDrive>(&model_->devices[device])) {
      if (drive->link != 0)
        throw std::invalid_argument("treel drive '" + drive->name + "' is not on the root link '" +
                                    model_->links[0].name + "'");
      drives_[device] = std::make_unique<TreelDrive>(multibody_.get(), body_, *drive, X_LB_[0].inverse(), scene);
      constraints_.push_back(drives_[device].get());
    }
  }
}

Pose Multibody::bullet_link_pose(std::size_t link) const {
  if (link == 0) return {to_eigen(multibody_->getBasePos()), to_eigen(multibody_->getWorldToBaseRot()).conjugate()};
  const btTransform& X_WB = multibody_->getLink(bullet_link(link)).m_cachedWorldTransform;
  return {to_eigen(X_WB.getOrigin()), to_eigen(X_WB.getRotation())};
}

Pose Multibody::link_pose(std::size_t link) const { return bullet_link_pose(link) * X_LB_[link].inverse(); }

Twist Multibody::link_twist(std::size_t link) const {
  // Down the chain from the root: each joint adds its own motion to its parent's.
  if (link == 0) {
    const Eigen::Vector3d angular = to_eigen(multibody_->getBaseOmega());
    const Eigen::Vector3d arm = link_pose(0).position - to_eigen(multibody_->getBasePos());
    return {angular, to_eigen(multibody_->getBaseVel()) + angular.cross(arm)};
  }
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const description::Joint& joint = model_->joints[j];
    if (joint.child != link) continue;
    const Twist parent = link_twist(joint.parent);
    const Pose X_WL = link_pose(link);
    const Pose X_WJ = X_WL * joint.X_LJ;
    const Eigen::Vector3d axis_W = X_WJ.orientation * joint.axis.direction;
    const double velocity = joint_velocity(j);
    const bool turns = joint.type == description::JointType::revolute;
    const Eigen::Vector3d relative_angular = turns ? Eigen::Vector3d(velocity * axis_W) : Eigen::Vector3d::Zero();
    const Eigen::Vector3d relative_linear = joint.type == description::JointType::prismatic
                                                ? Eigen::Vector3d(velocity * axis_W)
                                                : relative_angular.cross(X_WL.position - X_WJ.position);
    const Eigen::Vector3d arm = X_WL.position - link_pose(joint.parent).position;
    return {parent.angular_W + relative_angular, parent.linear_W + parent.angular_W.cross(arm) + relative_linear};
  }
  throw std::logic_error("link without a joint");  // the description sees to it that there is none
}

double Multibody::joint_position(std::size_t joint) const {
  if (model_->joints[joint].type == description::JointType::fixed) return 0.0;
  return multibody_->getJointPosMultiDof(bullet_link(model_->joints[joint].child))[0];
}

double Multibody::joint_velocity(std::size_t joint) const {
  if (model_->joints[joint].type == description::JointType::fixed) return 0.0;
  return multibody_->getJointVelMultiDof(bullet_link(model_->joints[joint].child))[0];
}

void Multibody::apply_forces(const Eigen::Vector3d& gravity, double step, Scratch& scratch) {
  const btVector3 g = to_bullet(gravity);
  multibody_->clearForcesAndTorques();
  multibody_->clearConstraintForces();
  multibody_->addBaseForce(g * multibody_->getBaseMass());
  for (int link = 0; link < multibody_->getNumLinks(); ++link)
    multibody_->addLinkForce(link, g * multibody_->getLinkMass(link));
  for (std::size_t j = 0; j < model_->joints.size(); ++j)
    if (model_->joints[j].axis.damping != 0.0)
      multibody_->addJointTorque(bullet_link(model_->joints[j].child), -model_->joints[j].axis.damping * joint_velocity(j));
  const bool constraint_pass = false;
  const bool feedback_in_world = false;
  const bool feedback_in_joint_frame = false;
  multibody_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(step, scratch.scalars, scratch.vectors,
                                                                   scratch.matrices, constraint_pass, feedback_in_world,
                                                                   feedback_in_joint_frame);
}

bool Multibody::integrate(double step, Scratch& scratch) {
  multibody_->processDeltaVeeMultiDof2();
  const double* velocities = multibody_->getVelocityVector();
  double sum = 0.0;
  for (int i = 0; i < 6 + multibody_->getNumDofs(); ++i) sum += velocities[i];
  if (!std::isfinite(sum)) return false;
  for (const auto& drive : drives_)
    if (drive) drive->advance_tracks(step);
  multibody_->stepPositionsMultiDof(step);
  multibody_->forwardKinematics(scratch.rotations, scratch.vectors);
  return true;
}

void Multibody::hash(StateHash& hash) const {
  const btVector3& position = multibody_->getBasePos();
  const btQuaternion& rotation = multibody_->getWorldToBaseRot();
  for (int i = 0; i < 3; ++i) hash.add(position[i]);
  for (int i = 0; i < 4; ++i) hash.add(rotation[i]);
  for (int i = 0; i < 6 + multibody_->getNumDofs(); ++i) hash.add(multibody_->getVelocityVector()[i]);
  for (std::size_t joint = 0; joint < motors_.size(); ++joint) {
    hash.add(joint_position(joint));
    if (motors_[joint]) hash.add(motors_[joint]->target());
  }
  for (const auto& drive : drives_) {
    if (!drive) continue;
    for (const Side side : {Side::left, Side::right}) {
      hash.add(drive->target(side));
      hash.add(drive->track(side).position);
      hash.add(drive->track(side).velocity);
    }
  }
  for (btMultiBodyConstraint* constraint : constraints_)
    for (int row = 0; row < constraint->getNumRows(); ++row) hash.add(constraint->getAppliedImpulse(row));
}

}  // namespace cohort::physics
