// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/mechanism.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <span>
#include <stdexcept>

#include "server/core/is_unit.hpp"

namespace cohort::physics {
namespace {

using description::JointType;

// Returns the inertia of a point mass at `offset` about the origin (parallel-axis theorem).
Eigen::Matrix3d inertia_of_point(double mass, const Eigen::Vector3d& offset) {
  return mass * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
}

const description::Joint* joint_above(const description::Model& model, std::size_t link) {
  for (const description::Joint& joint : model.joints)
    if (joint.child == link) return &joint;
  return nullptr;
}

DeviceOutputs::Wheels wheels_of(const Mechanism& mechanism, const description::TrackPair& pair,
                                const std::vector<std::size_t>& joints) {
  DeviceOutputs::Wheels side;
  side.radius = pair.wheel_radius;
  side.max_effort = pair.max_torque / static_cast<double>(std::max<std::size_t>(1, joints.size()));
  side.max_velocity = pair.max_velocity / pair.wheel_radius;
  for (const std::size_t joint : joints) {
    const Mechanism::JointPlace& place = mechanism.joint(joint);
    const Segment& wheel = mechanism.segments()[static_cast<std::size_t>(place.segment)];
    const Eigen::Vector3d axis = wheel.X_PS.orientation * wheel.axis_S;
    side.wheels.push_back({place.first_dof, axis.y() < 0.0 ? -1.0 : 1.0});
  }
  return side;
}

}  // namespace

Mechanism::Mechanism(const description::Model& model, description::Fidelity fidelity)
    : model_(&model), links_(model.links.size()), joints_(model.joints.size()) {
  std::vector<char> welded(model.joints.size(), 0);
  for (const description::Device& device : model.devices) {
    const description::TrackPair* const drive = description::tracks_of(device);
    if (drive == nullptr) continue;
    for (const auto* wheels : {&drive->left_wheels, &drive->right_wheels}) {
      for (const std::size_t wheel : *wheels) {
        if (fidelity == description::Fidelity::articulated) {
          has_wheels_ = true;
        } else {
          welded[wheel] = 1;
          links_[model.joints[wheel].child].collides = false;
        }
      }
    }
  }
  for (std::size_t link = 0; link < model.links.size(); ++link) add_link(link, welded);
  for (const description::Device& device : model.devices)
    for (const description::MotorLimits& motor : description::motor_limits(device))
      if (joints_[motor.joint].dofs > 0)
        dofs_[static_cast<std::size_t>(joints_[motor.joint].first_dof)].rotor_inertia = motor.rotor_inertia;
  find_followers();
  turn_to_principal_axes();
  sum_masses();
  sum_added_masses();
  if (has_kinematic_root()) make_root_immovable();
  find_outputs();
  assert(std::ranges::all_of(segments_, [](const Segment& segment) {
    return segment.mass >= 0.0 && segment.inertia_S.diagonal().minCoeff() >= 0.0 && is_unit(segment.X_PS.orientation);
  }));
  swings_freely_ = dof_count() > 1 && !is_held_by_rows();
}

bool Mechanism::is_held_by_rows() const {
  const auto has_motors = [](const description::Device& device) { return !description::motor_limits(device).empty(); };
  const auto has_friction = [](const Dof& dof) { return dof.axis.friction > 0.0; };
  return has_wheels_ || !followers_.empty() || !model_->loop_joints.empty() ||
         std::ranges::any_of(model_->devices, has_motors) || std::ranges::any_of(dofs_, has_friction);
}

void Mechanism::find_followers() {
  for (const description::Coupling& coupling : model_->couplings) {
    const JointPlace& follower = joints_[coupling.follower];
    const JointPlace& leader = joints_[coupling.leader];
    if (follower.dofs > 0 && leader.dofs > 0)
      followers_.push_back({follower.first_dof + (coupling.moves_second_axis ? 1 : 0),
                            leader.first_dof + (coupling.follows_second_axis ? 1 : 0), coupling.multiplier,
                            coupling.offset});
  }
}

void Mechanism::find_outputs() {
  std::size_t belts = 0;
  std::size_t rotors = 0;
  for (const description::Device& device : model_->devices) {
    std::vector<DeviceOutputs::Output>& outputs = outputs_.by_device.emplace_back();
    if (const description::TrackPair* const pair = description::tracks_of(device)) {
      if (links_[pair->link].segment != 0)
        throw std::invalid_argument("treel drive '" + description::name_of(device) + "' is not on the root link '" +
                                    model_->links[0].name + "'");
      if (has_wheels_ && !(pair->left_wheels.empty() && pair->right_wheels.empty())) {
        for (const auto* joints : {&pair->left_wheels, &pair->right_wheels})
          outputs.emplace_back(wheels_of(*this, *pair, *joints));
      } else {
        for (const Side side : {Side::left, Side::right})
          outputs.emplace_back(DeviceOutputs::Track{outputs_.tracks.size(), side});
        outputs_.tracks.push_back(pair);
      }
    }
    for (std::size_t i = description::belts_of(device).size(); i > 0; --i)
      outputs.emplace_back(DeviceOutputs::BeltLink{belts++});
    if (description::thruster_of(device) != nullptr) outputs.emplace_back(DeviceOutputs::Propeller{rotors++});
  }
}

// Gives the root such a large mass and spherical inertia that it cannot be moved or turned. The impulses of a robot in
// one step change its velocity by less than the resolution of a double.
void Mechanism::make_root_immovable() {
  constexpr double immovable = 1e15;  // [kg], [kg m^2]
  segments_[0].mass = immovable;
  segments_[0].inertia_S = immovable * Eigen::Matrix3d::Identity();
}

void Mechanism::turn_to_principal_axes() {
  constexpr double rounding = 1e-13;
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    Segment& segment = segments_[s];
    const Eigen::Matrix3d diagonal = segment.inertia_S.diagonal().asDiagonal();
    if ((segment.inertia_S - diagonal).cwiseAbs().maxCoeff() <= rounding * diagonal.trace()) {
      segment.inertia_S = diagonal;
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(segment.inertia_S);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
    const Eigen::Quaterniond turn(axes);
    const Eigen::Quaterniond back = turn.conjugate();
    segment.principal_axes = turn;
    segment.inertia_S = solver.eigenvalues().asDiagonal();
    segment.centre_S = back * segment.centre_S;
    segment.axis_S = back * segment.axis_S;
    segment.X_PS.orientation *= turn;
    const Pose to_segment{Eigen::Vector3d::Zero(), back};
    for (Segment& other : segments_)
      if (other.parent == static_cast<int>(s)) other.X_PS = to_segment * other.X_PS;
    for (LinkPlace& link : links_)
      if (link.segment == static_cast<int>(s)) link.X_SL = to_segment * link.X_SL;
  }
}

void Mechanism::sum_masses() {
  std::vector<double> masses;  // each segment with everything it carries
  for (const Segment& segment : segments_) masses.push_back(segment.mass);
  for (std::size_t s = segments_.size(); s-- > 0;)
    if (segments_[s].parent >= 0) masses[static_cast<std::size_t>(segments_[s].parent)] += masses[s];
  mass_beyond_.resize(dofs_.size());
  for (std::size_t s = 0; s < segments_.size(); ++s)
    std::fill_n(mass_beyond_.begin() + segments_[s].first_dof, segments_[s].dofs, masses[s]);
  for (const Segment& segment : segments_)
    if (segment.last_dof >= 0 && !(&segment == segments_.data() && has_kinematic_root())) moving_mass_ += segment.mass;
}

void Mechanism::sum_added_masses() {
  for (std::size_t link = 0; link < links_.size(); ++link) {
    const SpatialMatrix* const added = model_->links[link].inertial.added_mass.get();
    if (added == nullptr) continue;
    if (added_masses_.empty()) added_masses_.assign(segments_.size(), SpatialMatrix::Zero());
    added_masses_[static_cast<std::size_t>(links_[link].segment)] +=
        moved_inertia(*added, links_[link].X_SL, Eigen::Vector3d::Zero());
  }
}

void Mechanism::add_link(std::size_t link, const std::vector<char>& welded) {
  const description::Link& described = model_->links[link];
  const description::Joint* joint = joint_above(*model_, link);
  const Pose no_offset;
  if (joint == nullptr) {
    links_[link].segment = add_segment(-1, Motion::free, described.X_ML, Eigen::Vector3d::Zero(), nullptr);
    add_mass(links_[link].segment, described.inertial, no_offset);
    return;
  }

  const bool to_world = joint->parent == description::Joint::world;
  const int parent = to_world ? -1 : links_[joint->parent].segment;
  // Pose of the parent segment's frame, or the model's frame, in the model's frame.
  const Pose X_MP = to_world ? Pose{} : model_->links[joint->parent].X_ML * links_[joint->parent].X_SL.inverse();
  const Pose X_PL = X_MP.inverse() * described.X_ML;
  const Pose X_PJ = X_PL * joint->X_LJ;
  const Pose X_JL = joint->X_LJ.inverse();
  const auto index = static_cast<std::size_t>(joint - model_->joints.data());
  JointPlace& place = joints_[index];
  LinkPlace& linked = links_[link];
  linked.X_SL = X_JL;
  place.first_coordinate = static_cast<int>(zero_coordinates_.size());
  place.first_dof = dof_count();
  const Eigen::Vector3d& axis = joint->axis.direction;
  switch (welded[index] ? JointType::fixed : joint->type) {
    case JointType::fixed:
      if (to_world) {
        linked.segment = add_segment(-1, Motion::anchored, X_PJ, axis, nullptr);
      } else {
        linked.segment = parent;
        linked.X_SL = X_PL;
      }
      break;
    case JointType::revolute: linked.segment = add_segment(parent, Motion::revolute, X_PJ, axis, &joint->axis); break;
    case JointType::prismatic: linked.segment = add_segment(parent, Motion::prismatic, X_PJ, axis, &joint->axis); break;
    case JointType::ball: linked.segment = add_segment(parent, Motion::ball, X_PJ, axis, &joint->axis); break;
    case JointType::screw: {
      const int middle = add_segment(parent, Motion::revolute, X_PJ, axis, &joint->axis);
      linked.segment = add_segment(middle, Motion::prismatic, no_offset, axis, nullptr);
      followers_.push_back({dof_count() - 1, dof_count() - 2, joint->thread_pitch / (2.0 * M_PI), 0.0});
      break;
    }
    case JointType::universal: {
      const int middle = add_segment(parent, Motion::revolute, X_PJ, axis, &joint->axis);
      linked.segment =
          add_segment(middle, Motion::revolute, no_offset, joint->second_axis.direction, &joint->second_axis);
      break;
    }
  }
  place.segment = linked.segment;
  place.dofs = dof_count() - place.first_dof;
  add_mass(linked.segment, described.inertial, linked.X_SL);
}

int Mechanism::add_segment(int parent, Motion motion, const Pose& X_PS, const Eigen::Vector3d& axis_S,
                           const description::JointAxis* axis) {
  assert(parent < static_cast<int>(segments_.size()));
  assert(dofs_of(motion) != 1 || is_unit(axis_S));
  Segment segment;
  segment.parent = parent;
  segment.motion = motion;
  segment.X_PS = X_PS;
  segment.axis_S = axis_S;
  segment.first_dof = dof_count();
  segment.first_coordinate = static_cast<int>(zero_coordinates_.size());
  segment.dofs = dofs_of(motion);
  const std::span<const double> zero = zero_coordinates_of(motion);
  zero_coordinates_.insert(zero_coordinates_.end(), zero.begin(), zero.end());
  int above = parent < 0 ? -1 : segments_[static_cast<std::size_t>(parent)].last_dof;
  for (int i = 0; i < segment.dofs; ++i) {
    Dof dof;
    if (axis != nullptr) dof.axis = *axis;
    if (segment.dofs == 1) dof.coordinate = segment.first_coordinate;
    is_chain_ = is_chain_ && above == dof_count() - 1;
    parents_.push_back(above);
    above = dof_count();
    dofs_.push_back(dof);
  }
  segment.last_dof = above;
  segments_.push_back(segment);
  return static_cast<int>(segments_.size()) - 1;
}

void Mechanism::add_mass(int index, const description::Inertial& inertial, const Pose& X_SL) {
  Segment& segment = segments_[static_cast<std::size_t>(index)];
  const Pose X_SI = X_SL * inertial.X_LI;
  const Eigen::Matrix3d R = X_SI.orientation.toRotationMatrix();
  const double mass = segment.mass + inertial.mass;
  const Eigen::Vector3d centre = (segment.mass * segment.centre_S + inertial.mass * X_SI.position) / mass;
  segment.inertia_S += inertia_of_point(segment.mass, segment.centre_S - centre) +
                       R * inertial.inertia * R.transpose() + inertia_of_point(inertial.mass, X_SI.position - centre);
  segment.centre_S = centre;
  segment.mass = mass;
}

}  // namespace cohort::physics
