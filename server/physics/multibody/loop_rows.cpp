// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/loop_rows.hpp"

#include <algorithm>
#include <initializer_list>

#include "server/physics/dynamics/integration.hpp"
#include "server/physics/mechanism/rotation.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {

using description::Joint;
using description::JointType;
using Eigen::Vector3d;

LoopRows::LoopRows(const Mechanism& mechanism) {
  const description::Model& model = mechanism.model();
  for (const Joint& joint : model.loop_joints) {
    Loop& loop = loops_.emplace_back();
    loop.type = joint.type;
    loop.child_link = joint.child;
    loop.child = mechanism.link(joint.child).segment;
    loop.X_SP_child = mechanism.link(joint.child).X_SL * joint.X_LJ;
    loop.axis_P = joint.axis.direction;
    loop.second_axis_P = joint.second_axis.direction;
    const Pose X_MP = model.links[joint.child].X_ML * joint.X_LJ;
    if (joint.parent == Joint::world) {
      loop.parent_link = joint.child;
      loop.X_SP_parent = X_MP;
    } else {
      loop.parent_link = joint.parent;
      loop.parent = mechanism.link(joint.parent).segment;
      loop.X_SP_parent = mechanism.link(joint.parent).X_SL * model.links[joint.parent].X_ML.inverse() * X_MP;
    }
  }
}

bool LoopRows::reach_the_world() const {
  return std::ranges::any_of(loops_, [](const Loop& loop) { return loop.parent < 0; });
}

bool LoopRows::connect(int segment, int other) const {
  return std::ranges::any_of(loops_, [&](const Loop& loop) {
    return (loop.parent == segment && loop.child == other) || (loop.parent == other && loop.child == segment);
  });
}

LoopRows::Errors LoopRows::errors_of(const Loop& loop, const Pose& X_WPp, const Pose& X_WPc) {
  const Vector3d gap_W = X_WPc.position - X_WPp.position;
  const Vector3d axis_W = X_WPp.orientation * loop.axis_P;
  const Vector3d aside_W = X_WPp.orientation * loop.axis_P.unitOrthogonal();
  const Vector3d other_aside_W = axis_W.cross(aside_W);
  Errors errors;
  const auto add = [&](const Vector3d& error_W, std::initializer_list<Vector3d> directions_W) {
    for (const Vector3d& direction_W : directions_W) errors.add(direction_W, error_W.dot(direction_W));
  };
  if (loop.type != JointType::prismatic) add(gap_W, {axis_W});
  add(gap_W, {aside_W, other_aside_W});
  errors.linear = errors.count;
  switch (loop.type) {
    case JointType::ball: break;
    case JointType::fixed:
    case JointType::prismatic:
      add(rotation_vector(X_WPc.orientation * X_WPp.orientation.conjugate()), {axis_W, aside_W, other_aside_W});
      break;
    case JointType::revolute:
    case JointType::screw: add(axis_W.cross(X_WPc.orientation * loop.axis_P), {aside_W, other_aside_W}); break;
    case JointType::universal: {
      const Vector3d second_W = X_WPc.orientation * loop.second_axis_P;
      const Vector3d normal_W = second_W.cross(axis_W);
      const double sine = normal_W.norm();
      const double off = second_W.dot(axis_W) - loop.second_axis_P.dot(loop.axis_P);
      errors.add(normal_W.normalized(), sine > 0.0 ? off / sine : 0.0);
      break;
    }
  }
  return errors;
}

void LoopRows::add_rows(Problem& problem, int index, const BodyMotion& body, double step) {
  for (Loop& loop : loops_) {
    const Pose& X_WSp = loop.parent < 0 ? body.model_pose() : body.segment_pose(loop.parent);
    const Pose X_WPp = X_WSp * loop.X_SP_parent;
    const Pose X_WPc = body.segment_pose(loop.child) * loop.X_SP_child;
    const Anchor child{index, loop.child};
    const Anchor parent = loop.parent < 0 ? Anchor{} : Anchor{index, loop.parent};
    const Pose ahead_X_WSp = loop.parent < 0 ? X_WSp : pose_ahead(body, loop.parent, step);
    const Errors ahead =
        errors_of(loop, ahead_X_WSp * loop.X_SP_parent, pose_ahead(body, loop.child, step) * loop.X_SP_child);
    loop.errors = errors_of(loop, X_WPp, X_WPc);
    loop.point_W = 0.5 * (X_WPc.position + X_WPp.position);
    for (int i = 0; i < loop.errors.count; ++i) {
      const bool is_linear = i < loop.errors.linear;
      const Vector3d& direction_W = loop.errors.directions_W[at(i)];
      double* const kept = &loop.impulses[at(i)];
      Row& row = is_linear ? problem.add_force_row(child, parent, loop.point_W, direction_W, kept)
                           : problem.add_torque_row(child, parent, direction_W, kept);
      const double off = loop.errors.off[at(i)];
      row.target = correction(1.0, off, is_linear ? most_linear_correction : most_angular_correction, step) -
                   problem.velocity_by_turning(row, off, ahead.off[at(i)], step);
      if (row.inverse == 0.0) row.set_limits(0.0, 0.0);  // the tree already constrains it
    }
  }
}

}  // namespace cohort::physics
