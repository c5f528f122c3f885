#include "server/physics/multibody/loop_rows.hpp"

#include <algorithm>

#include "server/physics/dynamics/body_motion.hpp"
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

void LoopRows::add_rows(Problem& problem, int index, const BodyMotion& body, double step) {
  for (Loop& loop : loops_) {
    const Pose X_WPc = body.segment_pose(loop.child) * loop.X_SP_child;
    const Pose X_WPp = (loop.parent < 0 ? body.model_pose() : body.segment_pose(loop.parent)) * loop.X_SP_parent;
    const Anchor child{index, loop.child};
    const Anchor parent = loop.parent < 0 ? Anchor{} : Anchor{index, loop.parent};
    const Vector3d gap_W = X_WPc.position - X_WPp.position;
    const Vector3d turn_W = rotation_vector(X_WPc.orientation * X_WPp.orientation.conjugate());
    const Vector3d axis_W = X_WPp.orientation * loop.axis_P;
    const Vector3d aside_W = X_WPp.orientation * loop.axis_P.unitOrthogonal();
    const Vector3d other_aside_W = axis_W.cross(aside_W);
    loop.point_W = 0.5 * (X_WPc.position + X_WPp.position);
    loop.row_count = 0;
    const auto keep = [&](const Vector3d& direction_W) -> double* {
      loop.directions_W[at(loop.row_count)] = direction_W;
      return &loop.impulses[at(loop.row_count++)];
    };
    const auto correct = [&](Row& row, double off, double most) {
      row.target = correction(off, most, step);
      if (row.inverse == 0.0) row.set_limits(0.0, 0.0);  // the tree already constrains it
    };
    const auto hold = [&](const Vector3d& direction_W) {
      correct(problem.add_force_row(child, parent, loop.point_W, direction_W, keep(direction_W)),
              gap_W.dot(direction_W), most_linear_correction);
    };
    const auto hold_turn = [&](const Vector3d& direction_W, double off) {
      correct(problem.add_torque_row(child, parent, direction_W, keep(direction_W)), off, most_angular_correction);
    };

    if (loop.type != JointType::prismatic) hold(axis_W);
    hold(aside_W);
    hold(other_aside_W);
    loop.linear_count = loop.row_count;
    switch (loop.type) {
      case JointType::ball: break;
      case JointType::fixed:
      case JointType::prismatic:
        for (const Vector3d& direction_W : {axis_W, aside_W, other_aside_W})
          hold_turn(direction_W, turn_W.dot(direction_W));
        break;
      case JointType::revolute:
      case JointType::screw: {
        const Vector3d tilt_W = axis_W.cross(X_WPc.orientation * loop.axis_P);
        for (const Vector3d& direction_W : {aside_W, other_aside_W}) hold_turn(direction_W, tilt_W.dot(direction_W));
        break;
      }
      case JointType::universal: {
        const Vector3d second_W = X_WPc.orientation * loop.second_axis_P;
        const double off = second_W.dot(axis_W) - loop.second_axis_P.dot(loop.axis_P);
        hold_turn(second_W.cross(axis_W).normalized(), off);
        break;
      }
    }
  }
}

}  // namespace cohort::physics
