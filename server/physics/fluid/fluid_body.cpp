// SPDX-License-Identifier: Apache-2.0
#include "server/physics/fluid/fluid_body.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "server/physics/fluid/fluid_forces.hpp"
#include "server/physics/mechanism/lanes.hpp"

namespace cohort::physics {
namespace {

using Eigen::Vector3d;

Spatial force_along(const Vector3d& direction_W) { return {Vector3d::Zero(), direction_W}; }
Spatial torque_about(const Vector3d& direction_W) { return {direction_W, Vector3d::Zero()}; }

}  // namespace

FluidBody::FluidBody(std::shared_ptr<const FluidModel> model)
    : model_(std::move(model)), rotors_(model_->rotors.size()), submerged_(model_->floats.size()) {}

OutputState FluidBody::state(const DeviceOutputs::Propeller& rotor) const {
  const description::Thruster& thruster = *model_->rotors[rotor.index].thruster;
  const double velocity = rotors_[rotor.index].velocity;
  return {0.0, velocity, thruster.moment_constant * thruster.motor_constant * std::abs(velocity) * velocity};
}

void FluidBody::finish_step() {
  for (RotorState& rotor : rotors_) rotor.velocity = rotor.after;
}

void FluidBody::stop() {
  for (RotorState& rotor : rotors_) rotor.velocity = 0.0;
}

FluidBody::Here FluidBody::here(const Place& place, const Equations& equations, const Media& media) {
  const Pose X_WP = equations.body().segment_pose(place.segment) * place.X_SP;
  return {X_WP, media.at(X_WP.position, place.feels_wind)};
}

void FluidBody::apply(Equations& equations, const Media& media, double step) {
  impulses_.clear();
  for (std::size_t i = 0; i < model_->floats.size(); ++i) {
    const FluidModel::Float& floating = model_->floats[i];
    const Pose X_WC = equations.body().segment_pose(floating.segment) * floating.X_SP;
    submerged_[i] = floating.shape.below(media.water->level, X_WC);
    if (submerged_[i].volume > 0.0)
      push(floating, submerged_[i].centre_W,
           force_along(-step * media.water->density * submerged_[i].volume * media.gravity), equations);
  }
  for (std::size_t i = 0; i < rotors_.size(); ++i) push_by_rotor(i, equations, media, step);

  for (std::size_t i = 0, next = 0; i < model_->floats.size(); i = next) {
    SubmergedPart of_link = submerged_[i];
    for (next = i + 1; next < model_->floats.size() && model_->floats[next].link == model_->floats[i].link; ++next)
      of_link.add(submerged_[next]);
    stiffen(model_->floats[i], of_link, media, equations, step);
  }
  for (std::size_t i = 0; i < rotors_.size(); ++i) drag_rotor(i, equations, media, step);
  for (const FluidModel::FinPlace& fin : model_->fins) push_fin(fin, equations, media, step);
  for (const FluidModel::DragPlace& drag : model_->drags) damp(drag, equations, media, step);
  for (const FluidModel::Windage& windage : model_->windages) blow(windage, equations, media, step);
}

// The motor is a first-order system, integrated exactly for a target that is constant over the step.
void FluidBody::push_by_rotor(std::size_t index, Equations& equations, const Media& media, double step) {
  const FluidModel::RotorPlace& placed = model_->rotors[index];
  const description::Thruster& rotor = *placed.thruster;
  RotorState& state = rotors_[index];
  const double time_constant = state.target > state.velocity ? rotor.time_constant_up : rotor.time_constant_down;
  state.after = state.target + (state.velocity - state.target) * std::exp(-step / time_constant);
  if (state.after == 0.0) return;
  const Here at = here(placed, equations, media);
  const Vector3d axis_W = at.X_WP.orientation * Vector3d::UnitZ();
  const double thrust =
      share_of_density(rotor.density, at.medium) * rotor.motor_constant * state.after * std::abs(state.after);
  push(placed, at.X_WP.position,
       {rotor.reaction_sense() * step * rotor.moment_constant * thrust * axis_W, step * thrust * axis_W}, equations);
}

// Applies the change of the buoyancy of a link as it sinks and tilts during the step. It tilts about the principal axes
// of the section, so that each axis is an independent damper. Tilting submerges a wedge of the section, which rights
// the body. It also moves the centre of buoyancy aside from the centre of mass. This heels the body further if the
// centre of buoyancy is the lower one. Together, their stiffness is ρ g V times the metacentric height. If it is
// negative, nothing damps the tilting.
void FluidBody::stiffen(const Place& link, const SubmergedPart& part, const Media& media, Equations& equations,
                        double step) {
  const double weight = -media.gravity.z() * media.water->density;  // specific weight of water [N/m^3]
  if (!(part.area > 0.0) || !(weight > 0.0)) return;
  aim(link, part.area_centre_W, force_along(Vector3d::UnitZ()), equations);
  damp_along(0.0, step * weight * part.area, 0.0, equations, step);
  const BodyMotion& motion = equations.body();
  const Segment& segment = motion.mechanism().segments()[static_cast<std::size_t>(link.segment)];
  const double rise = (motion.segment_pose(link.segment) * segment.centre_S).z() - part.centre_W.z();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> section;
  section.computeDirect(part.second_moment_W);
  for (int i = 0; i < 2; ++i) {
    const double righting = std::max(0.0, section.eigenvalues()[i]) - part.volume * rise;
    if (!(righting > 0.0)) continue;
    const Eigen::Vector2d across = section.eigenvectors().col(i);
    aim(link, part.area_centre_W, torque_about({-across.y(), across.x(), 0.0}), equations);
    damp_along(0.0, step * weight * righting, 0.0, equations, step);
  }
}

void FluidBody::drag_rotor(std::size_t index, Equations& equations, const Media& media, double step) {
  const FluidModel::RotorPlace& placed = model_->rotors[index];
  const description::Thruster& rotor = *placed.thruster;
  const double speed = std::abs(rotors_[index].after);
  if (speed == 0.0 || (rotor.drag_coefficient == 0.0 && rotor.rolling_moment_coefficient == 0.0)) return;
  const Here at = here(placed, equations, media);
  const double turning = speed * share_of_density(rotor.density, at.medium);
  for (const Vector3d& axis_P : {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY())}) {
    const Vector3d axis_W = at.X_WP.orientation * axis_P;
    aim(placed, at.X_WP.position, force_along(axis_W), equations);
    damp_along(axis_W.dot(at.medium.velocity_W), turning * rotor.drag_coefficient, 0.0, equations, step);
    const double across = velocity(equations) - axis_W.dot(at.medium.velocity_W);
    push(placed, at.X_WP.position, torque_about(-step * turning * rotor.rolling_moment_coefficient * across * axis_W),
         equations);
  }
}

// Applies lift and drag of a fin, first along its upward axis, then along its forward axis. Upwards, the force acts
// like a damper towards the velocity of zero lift, or towards rest if it points that way; it never overshoots this
// velocity. For a fin that is not stalled, the force is such a damper. Lift does no work and drag removes energy, both
// of the motion relative to the fluid. So the forward impulse returns at most the energy that the upward one removed.
void FluidBody::push_fin(const FluidModel::FinPlace& placed, Equations& equations, const Media& media, double step) {
  const Here at = here(placed, equations, media);
  const Eigen::Matrix3d R = at.X_WP.orientation.toRotationMatrix();
  const Vector3d fluid_F = R.transpose() * at.medium.velocity_W;
  const auto aim_along = [&](int axis) { aim(placed, at.X_WP.position, force_along(R.col(axis)), equations); };
  const auto relative_velocity = [&] {
    Vector3d v_F;
    for (int axis = 0; axis < 3; ++axis) {
      aim_along(axis);
      v_F[axis] = velocity(equations) - fluid_F[axis];
    }
    return v_F;
  };
  const auto force_at = [&](const Vector3d& v_F) { return fin_force(*placed.fin, at.medium.density, v_F); };

  Vector3d v_F = relative_velocity();
  const double upwards = force_at(v_F).y();
  const double to_no_lift = placed.no_lift * v_F.x() - v_F.z();
  const double way = upwards * to_no_lift > 0.0 ? to_no_lift : -v_F.z();
  aim_along(2);
  double answer = response(equations);
  const double damping = upwards * way > 0.0 ? upwards / way : 0.0;
  double impulse = step * upwards / (1.0 + step * damping * answer);
  const double energy = impulse * (v_F.z() + 0.5 * answer * impulse);
  push(impulse, equations);

  v_F = relative_velocity();
  impulse = step * force_at(v_F).x();
  aim_along(0);
  answer = response(equations);
  if (answer > 0.0) {
    const double spread = std::sqrt(std::max(0.0, v_F.x() * v_F.x() - 2.0 * answer * energy));
    impulse = std::clamp(impulse, (-v_F.x() - spread) / answer, (-v_F.x() + spread) / answer);
  }
  push(impulse, equations);
}

void FluidBody::damp(const FluidModel::DragPlace& placed, Equations& equations, const Media& media, double step) {
  const description::Drag& drag = *placed.drag;
  const Here at = here(placed, equations, media);
  const double share = share_of_density(drag.density, at.medium);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d axis_W = at.X_WP.orientation * Vector3d::Unit(axis);
    const auto damp_by = [&](const Spatial& unit_W, double fluid_velocity, double linear, double quadratic) {
      if (linear == 0.0 && quadratic == 0.0) return;
      aim(placed, at.X_WP.position, unit_W, equations);
      damp_along(fluid_velocity, share * linear, share * quadratic, equations, step);
    };
    damp_by(force_along(axis_W), axis_W.dot(at.medium.velocity_W), drag.damping[axis], drag.quadratic_damping[axis]);
    damp_by(torque_about(axis_W), 0.0, drag.angular_damping[axis], drag.quadratic_angular_damping[axis]);
  }
}

void FluidBody::blow(const FluidModel::Windage& windage, Equations& equations, const Media& media, double step) {
  const Here at = here(windage, equations, media);
  if (media.has_water_at(at.X_WP.position)) return;
  for (int axis = 0; axis < 3; ++axis) {
    aim(windage, at.X_WP.position, force_along(Vector3d::Unit(axis)), equations);
    damp_along(at.medium.velocity_W[axis], windage.mass * media.air.wind_force, 0.0, equations, step);
  }
}

void FluidBody::aim(const Place& place, const Vector3d& point_W, const Spatial& unit_W, const Equations& equations) {
  aimed_ = {place.link, point_W, unit_W};
  jacobian_.assign(static_cast<std::size_t>(equations.stride()), 0.0);
  equations.add_force(place.segment, point_W, unit_W.linear, jacobian_.data());
  equations.add_torque(place.segment, unit_W.angular, jacobian_.data());
}

double FluidBody::velocity(const Equations& equations) const {
  return equations.size() > 0 ? dot(jacobian_.data(), equations.velocity(), equations.stride()) : 0.0;
}

double FluidBody::response(Equations& equations) {
  if (equations.size() == 0) return 0.0;
  response_.resize(jacobian_.size());
  equations.respond(jacobian_.data(), response_.data());
  return dot(jacobian_.data(), response_.data(), equations.stride());
}

// Applies an impulse in the present direction. Call `response` first.
void FluidBody::push(double impulse, Equations& equations) {
  if (equations.size() > 0) add_scaled(impulse, response_.data(), equations.velocity(), equations.stride());
  const Spatial impulse_W{impulse * aimed_.impulse_W.angular, impulse * aimed_.impulse_W.linear};
  equations.count_push(aimed_.point_W, impulse_W);
  impulses_.push_back({aimed_.link, aimed_.point_W, impulse_W});
}

void FluidBody::push(const Place& place, const Vector3d& point_W, const Spatial& impulse_W, Equations& equations) {
  aim(place, point_W, impulse_W, equations);
  response(equations);
  push(1.0, equations);
}

void FluidBody::damp_along(double fluid_velocity, double linear, double quadratic, Equations& equations, double step) {
  const double answer = response(equations);
  push(damping_impulse(velocity(equations) - fluid_velocity, linear, quadratic, answer, step), equations);
}

}  // namespace cohort::physics
