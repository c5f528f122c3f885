// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_model.hpp"

#include <stdexcept>

namespace cohort::physics {

PlanarModel::PlanarModel(const description::Model& model)
    : mechanism_(model, description::Fidelity::planar),
      motor_of_joint_(model.joints.size(), no_motor),
      motor_of_segment_(mechanism_.segments().size(), no_motor) {
  const std::vector<Segment>& segments = mechanism_.segments();
  for (std::size_t s = 0; s < segments.size(); ++s)
    if (segments[s].parent < 0 &&
        (s > 0 || (segments[s].motion != Motion::free && segments[s].motion != Motion::anchored)))
      throw std::invalid_argument("planar physics does not support joints to the world that are not fixed");
  if (!model.fins.empty())
    throw std::invalid_argument("planar physics does not support fin '" + model.fins[0].name + "'");
  if (!model.drags.empty())
    throw std::invalid_argument("planar physics does not support drag '" + model.drags[0].name + "'");
  if (!mechanism_.added_masses().empty())
    throw std::invalid_argument("planar physics does not support <fluid_added_mass>");
  if (!model.loop_joints.empty())
    throw std::invalid_argument("planar physics does not support joints that close loops");
  if (!mechanism_.followers().empty())
    throw std::invalid_argument("planar physics does not support mimic and screw joints");
  for (const description::Device& device : model.devices) {
    for (const description::MotorLimits& motor : description::motor_limits(device))
      add_motor(motor, description::name_of(device));
    if (const std::string reason = description::reason_against_planar(device); !reason.empty())
      throw std::invalid_argument(reason);
    if (const description::TrackPair* const drive = description::tracks_of(device)) {
      if (drive_ != nullptr) throw std::invalid_argument("planar physics supports only one treel drive per robot");
      drive_ = drive;
    }
  }
  add_masses();
}

void PlanarModel::add_motor(const description::MotorLimits& motor, const std::string& name) {
  const description::Joint& joint = mechanism_.model().joints[motor.joint];
  const Mechanism::JointPlace& place = mechanism_.joint(motor.joint);
  if (place.dofs == 0) throw std::invalid_argument("motor '" + name + "' drives the fixed joint '" + joint.name + "'");
  const Dof& dof = mechanism_.dofs()[static_cast<std::size_t>(place.first_dof)];
  if (dof.coordinate < 0)
    throw std::invalid_argument("motor '" + name + "' drives the ball joint '" + joint.name +
                                "', which planar physics does not support");
  if (motor_of_joint_[motor.joint] != no_motor)
    throw std::invalid_argument("motor '" + name + "' drives a joint that already has a motor");
  // The first axis of a universal joint belongs to the segment in its middle.
  int segment = place.segment;
  while (mechanism_.segments()[static_cast<std::size_t>(segment)].first_coordinate != dof.coordinate)
    segment = mechanism_.segments()[static_cast<std::size_t>(segment)].parent;
  motor_of_joint_[motor.joint] = static_cast<int>(motors_.size());
  motor_of_segment_[static_cast<std::size_t>(segment)] = static_cast<int>(motors_.size());
  motors_.push_back(
      {segment, static_cast<std::size_t>(dof.coordinate), dof.axis.lower, dof.axis.upper, motor.max_velocity});
}

void PlanarModel::add_masses() {
  const std::vector<Segment>& segments = mechanism_.segments();
  std::vector<Pose> X_MS;
  for (const Segment& segment : segments) {
    X_MS.push_back(segment.parent < 0 ? segment.X_PS : X_MS[static_cast<std::size_t>(segment.parent)] * segment.X_PS);
    mass_ += segment.mass;
    centre_M_ += segment.mass * (X_MS.back() * segment.centre_S);
  }
  centre_M_ /= mass_;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Eigen::Matrix3d R = X_MS[s].orientation.toRotationMatrix();
    const Eigen::Vector3d offset = X_MS[s] * segments[s].centre_S - centre_M_;
    inertia_M_ += R * segments[s].inertia_S * R.transpose() +
                  segments[s].mass * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
  }
}

}  // namespace cohort::physics
