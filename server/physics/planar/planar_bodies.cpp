// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_bodies.hpp"

#include <algorithm>

namespace cohort::physics {

using Eigen::Vector3d;

namespace {

struct HalfTurn {
  double cosine;
  double sine;
};
// Returns sine and cosine of half an angle. For the usual rotation in one step, the Taylor series are exact to the last
// bits.
HalfTurn half_turn(double angle) {
  constexpr double small = 0.2;  // [rad]
  const double half = 0.5 * angle;
  if (std::abs(angle) > small) return {std::cos(half), std::sin(half)};
  const double x = half * half;
  return {1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x * (1.0 / 3628800))))),
          half * (1.0 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880)))))};
}

}  // namespace

std::uint32_t PlanarBodies::add(const PlanarModel& model, const Pose& X_WM) {
  const auto index = static_cast<std::uint32_t>(members_.size());
  const Mechanism& mechanism = model.mechanism();
  members_.push_back({&model, X_BS_.size(), coordinates_.size(), motors_.size(), false});

  places_.emplace_back();
  velocities_.emplace_back();
  inertias_.emplace_back();
  X_BS_.resize(X_BS_.size() + mechanism.segments().size());
  coordinates_.resize(coordinates_.size() + mechanism.zero_coordinates().size());
  motors_.resize(motors_.size() + model.motors().size());
  renew(index, X_WM);
  return index;
}

void PlanarBodies::renew(std::uint32_t index, const Pose& X_WM) {
  Member& member = members_[index];
  const PlanarModel& model = *member.model;
  member.has_moving_joints = false;
  velocities_[index] = {};
  const Vector3d up_M = X_WM.orientation.conjugate() * Vector3d::UnitZ();
  inertias_[index] = model.is_immovable() ? PlanarInertia{}
                                          : PlanarInertia{1.0 / model.mass(), 1.0 / up_M.dot(model.inertia() * up_M)};
  std::ranges::copy(model.mechanism().zero_coordinates(),
                    coordinates_.begin() + static_cast<std::ptrdiff_t>(member.first_coordinate));
  std::fill_n(motors_.begin() + static_cast<std::ptrdiff_t>(member.first_motor), model.motors().size(), Motor{});
  put(index, X_WM);
}

void PlanarBodies::put(std::uint32_t index, const Pose& X_WM) {
  const Member& member = members_[index];
  const Vector3d centre_W = X_WM * member.model->centre();
  PlanarPlace place;
  place.x = centre_W.x();
  place.y = centre_W.y();
  places_[index] = place;
  const Pose X_BM{X_WM.position - Vector3d(centre_W.x(), centre_W.y(), 0.0), X_WM.orientation};
  X_BS_[member.first_segment] = X_BM * member.model->mechanism().segments()[0].X_PS;
  update_segments(member);
}

void PlanarBodies::place(std::uint32_t member, const Pose& X_WM) {
  stop(member);
  put(member, X_WM);
}

void PlanarBodies::stop(std::uint32_t member) {
  velocities_[member] = {};
  for (std::size_t i = 0; i < model(member).motors().size(); ++i)
    motors_[members_[member].first_motor + i].velocity = 0.0;
}

void PlanarBodies::push(std::uint32_t member, const Vector3d& point_W, const Vector3d& impulse_W,
                        const Vector3d& angular_impulse_W) {
  const PlanarPlace& place = places_[member];
  const PlanarInertia& inertia = inertias_[member];
  PlanarVelocity& velocity = velocities_[member];
  velocity.x += inertia.inverse_mass * impulse_W.x();
  velocity.y += inertia.inverse_mass * impulse_W.y();
  const double turn = (point_W.x() - place.x) * impulse_W.y() - (point_W.y() - place.y) * impulse_W.x();
  velocity.spin += inertia.inverse_inertia * (turn + angular_impulse_W.z());
}

void PlanarBodies::update_segments(const Member& member) {
  const std::vector<Segment>& segments = member.model->mechanism().segments();
  Pose* const X_BS = X_BS_.data() + member.first_segment;
  for (std::size_t s = 1; s < segments.size(); ++s) {
    const double* coordinates =
        coordinates_.data() + member.first_coordinate + static_cast<std::size_t>(segments[s].first_coordinate);
    X_BS[s] = moved_by_joint(segments[s], X_BS[segments[s].parent] * segments[s].X_PS, coordinates);
  }
}

Pose PlanarBodies::link_pose(std::uint32_t member, std::size_t link) const {
  const Mechanism::LinkPlace& place = model(member).mechanism().link(link);
  return places_[member] * (segment_in_body(member, place.segment) * place.X_SL);
}

Twist PlanarBodies::link_twist(std::uint32_t member, std::size_t link) const {
  const Vector3d origin_W = link_pose(member, link).position;
  Twist twist = twist_in_body(member, model(member).mechanism().link(link).segment, origin_W);
  const PlanarVelocity& velocity = velocities_[member];
  const PlanarPlace& place = places_[member];
  twist.angular_W.z() += velocity.spin;
  twist.linear_W.x() += velocity.x - velocity.spin * (origin_W.y() - place.y);
  twist.linear_W.y() += velocity.y + velocity.spin * (origin_W.x() - place.x);
  return twist;
}

Twist PlanarBodies::twist_in_body(std::uint32_t index, int segment, const Vector3d& point_W) const {
  Twist twist{Vector3d::Zero(), Vector3d::Zero()};
  const Member& member = members_[index];
  const std::vector<Segment>& segments = member.model->mechanism().segments();
  for (int s = segment; s > 0; s = segments[static_cast<std::size_t>(s)].parent) {
    const int motor = member.model->motor_of_segment(s);
    if (motor == PlanarModel::no_motor) continue;
    const double velocity = motors_[member.first_motor + static_cast<std::size_t>(motor)].velocity;
    if (velocity == 0.0) continue;
    const Segment& moved = segments[static_cast<std::size_t>(s)];
    const Pose X_WS = segment_pose(index, s);
    const Vector3d along_W = velocity * (X_WS.orientation * moved.axis_S);
    if (moved.motion == Motion::prismatic) {
      twist.linear_W += along_W;
    } else {
      twist.angular_W += along_W;
      twist.linear_W += along_W.cross(point_W - X_WS.position);
    }
  }
  return twist;
}

double PlanarBodies::joint_position(std::uint32_t member, std::size_t joint) const {
  const Mechanism::JointPlace& place = model(member).mechanism().joint(joint);
  if (place.dofs == 0) return 0.0;
  return coordinates_[members_[member].first_coordinate + static_cast<std::size_t>(place.first_coordinate)];
}

double PlanarBodies::joint_velocity(std::uint32_t member, std::size_t joint) const {
  const int motor = model(member).motor_of_joint(joint);
  if (motor == PlanarModel::no_motor) return 0.0;
  return motors_[members_[member].first_motor + static_cast<std::size_t>(motor)].velocity;
}

void PlanarBodies::set_root_twist(std::uint32_t member, const Twist& twist) {
  const Vector3d origin_W = link_pose(member, 0).position;
  const PlanarPlace& place = places_[member];
  const double spin = twist.angular_W.z();
  velocities_[member] = {twist.linear_W.x() - spin * (place.y - origin_W.y()),
                         twist.linear_W.y() + spin * (place.x - origin_W.x()), spin};
}

void PlanarBodies::set_joint_state(std::uint32_t member, std::size_t joint, std::span<const double> coordinates,
                                   std::span<const double> velocities) {
  const Mechanism::JointPlace& place = model(member).mechanism().joint(joint);
  const std::size_t first = members_[member].first_coordinate + static_cast<std::size_t>(place.first_coordinate);
  std::copy(coordinates.begin(), coordinates.end(), coordinates_.begin() + static_cast<std::ptrdiff_t>(first));
  if (const int motor = model(member).motor_of_joint(joint); motor != PlanarModel::no_motor && !velocities.empty())
    motors_[members_[member].first_motor + static_cast<std::size_t>(motor)].velocity = velocities[0];
  update_segments(members_[member]);
}

void PlanarBodies::set_joint_target(std::uint32_t member, std::size_t joint, JointRows::Control control,
                                    double target) {
  const auto index = static_cast<std::size_t>(model(member).motor_of_joint(joint));
  Motor& motor = motors_[members_[member].first_motor + index];
  motor.control = control;
  motor.target = target;
}

void PlanarBodies::drive_joints(std::uint32_t index, double step) {
  Member& member = members_[index];
  member.has_moving_joints = false;
  const std::vector<PlanarModel::Motor>& described = member.model->motors();
  for (std::size_t i = 0; i < described.size(); ++i) {
    Motor& motor = motors_[member.first_motor + i];
    const double position = coordinates_[member.first_coordinate + described[i].coordinate];
    switch (motor.control) {
      case JointRows::Control::velocity: motor.velocity = motor.target; break;
      case JointRows::Control::position:
        motor.velocity =
            std::clamp((motor.target - position) / step, -described[i].max_velocity, described[i].max_velocity);
        break;
      case JointRows::Control::effort: motor.velocity = 0.0; break;
    }
    if (motor.velocity == 0.0) continue;
    if (position + step * motor.velocity > described[i].upper)
      motor.velocity = std::max(0.0, (described[i].upper - position) / step);
    if (position + step * motor.velocity < described[i].lower)
      motor.velocity = std::min(0.0, (described[i].lower - position) / step);
    member.has_moving_joints = true;
  }
}

bool PlanarBodies::is_sensible(std::uint32_t index) const {
  constexpr double senseless = 1e6;  // [m/s or rad/s]
  const PlanarVelocity& velocity = velocities_[index];
  double sum = std::abs(velocity.x) + std::abs(velocity.y) + std::abs(velocity.spin);
  const Member& member = members_[index];
  if (member.has_moving_joints)
    for (std::size_t i = 0; i < member.model->motors().size(); ++i)
      sum += std::abs(motors_[member.first_motor + i].velocity);
  return sum < senseless;
}

bool PlanarBodies::integrate(std::uint32_t index, double step) {
  const PlanarVelocity& velocity = velocities_[index];
  PlanarPlace& place = places_[index];
  place.x += step * velocity.x;
  place.y += step * velocity.y;
  const HalfTurn turn = half_turn(step * velocity.spin);
  const double w = turn.cosine * place.turn_w - turn.sine * place.turn_z;
  const double z = turn.cosine * place.turn_z + turn.sine * place.turn_w;
  const double norm = std::sqrt(w * w + z * z);
  place.turn_w = w / norm;
  place.turn_z = z / norm;
  place.find_whole_turn();

  const Member& member = members_[index];
  if (!member.has_moving_joints) return false;
  for (std::size_t i = 0; i < member.model->motors().size(); ++i) {
    const double way = step * motors_[member.first_motor + i].velocity;
    coordinates_[member.first_coordinate + member.model->motors()[i].coordinate] += way;
  }
  update_segments(member);
  return true;
}

void PlanarBodies::update_poses(std::uint32_t member) {
  places_[member].find_whole_turn();
  update_segments(members_[member]);
}

}  // namespace cohort::physics
