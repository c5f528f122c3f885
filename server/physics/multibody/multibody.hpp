// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/dynamics/integration.hpp"
#include "server/physics/multibody/belts.hpp"
#include "server/physics/multibody/joint_rows.hpp"
#include "server/physics/multibody/loop_rows.hpp"
#include "server/physics/multibody/track_rows.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// One moving instance of a model: its motion, its rows, and the devices that drive it.
class Multibody {
 public:
  /// Places the model at X_WM with all its joints at zero. The mechanism is shared and must outlive this. Throws
  /// std::invalid_argument for a device that cannot be simulated.
  Multibody(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM, BodyId body);
  Multibody(const Multibody&) = delete;
  Multibody& operator=(const Multibody&) = delete;

  const Mechanism& mechanism() const { return motion_.mechanism(); }
  BodyId body() const { return body_; }
  BodyMotion& motion() { return motion_; }
  const BodyMotion& motion() const { return motion_; }

  /// Sets the command of a joint's motor, which must exist; returns whether it changed.
  bool set_joint_target(std::size_t joint, JointRows::Control control, double target);
  /// Returns the effort of the joint's motor over the last step [N m] or [N], 0 if it has none.
  double joint_effort(std::size_t joint) const;

  /// Sets the target velocity of a device's output; returns whether it changed.
  bool set_target(const DeviceOutputs::Track& track, double velocity) {
    return treels_[track.pair].set_target(track.side, velocity);
  }
  bool set_target(const DeviceOutputs::Wheels& side, double velocity);
  bool set_target(const DeviceOutputs::BeltLink& belt, double velocity) {
    return belts_.set_velocity(belt.index, velocity);
  }
  OutputState state(const DeviceOutputs::Track& track) const { return treels_[track.pair].track(track.side); }
  OutputState state(const DeviceOutputs::Wheels& side) const;
  OutputState state(const DeviceOutputs::BeltLink& belt) const { return belts_.state(belt.index); }

  RunningSurface surface_of(std::size_t link) const { return belts_.of_link(link, motion_.segment_poses()); }

  bool has_belts() const { return !belts_.is_empty(); }
  /// Returns whether it is a single rigid body without any drive.
  bool is_inert() const { return mechanism().is_free_body() && treels_.empty() && !has_belts(); }
  /// Clears the loads of the belts.
  void unload_belts() { belts_.unload(); }
  /// Adds a force over the last step to the load of a link with a belt, where its surface faces `outward_W`.
  void load_belt(std::size_t link, const Eigen::Vector3d& outward_W, const Eigen::Vector3d& force_W) {
    belts_.load(link, motion_.segment_poses(), outward_W, force_W);
  }

  const LoopRows& loops() const { return loops_; }
  /// Returns the track drives that stand on the ground without wheels.
  std::vector<TrackRows>& treels() { return treels_; }
  const std::vector<TrackRows>& treels() const { return treels_; }

  /// Changes the velocities by the motors with an effort command.
  void apply_efforts(Equations& equations, double step) { joints_.apply_efforts(equations, step); }
  /// Adds the rows of joints and drives. `index`: index of this body in the problem.
  void add_rows(Problem& problem, int index, const Anchors& anchors, double step);
  /// Moves the body with the velocities that the solver found.
  void integrate(const double* velocities, double step) {
    last_step_ = step;
    physics::integrate(motion_, velocities, step);
  }
  /// Moves a body in flight; the parameters are those of physics::fly.
  void fly(const double* velocities, const Eigen::Vector3d& impulse_W, const Eigen::Vector3d& angular_impulse_W,
           const Eigen::Vector3d& gravity, double step) {
    last_step_ = step;
    physics::fly(motion_, velocities, impulse_W, angular_impulse_W, gravity, step);
  }
  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    BodyMotion::visit_state(self.motion_, visit);
    JointRows::visit_state(self.joints_, visit);
    LoopRows::visit_state(self.loops_, visit);
    for (auto& treel : self.treels_) TrackRows::visit_state(treel, visit);
    Belts::visit_state(self.belts_, visit);
    visit(self.last_step_);
  }
  /// Calls `visit` for each load of its belts; loads are saved but not part of the state.
  template <class Self, class Visit>
  static void visit_loads(Self& self, Visit&& visit) {
    Belts::visit_loads(self.belts_, visit);
  }

 private:
  void build_devices();
  void add_motor(int dof, double max_effort, double max_velocity, const std::string& device);

  BodyMotion motion_;
  BodyId body_;
  JointRows joints_;
  LoopRows loops_;
  Belts belts_;
  std::vector<TrackRows> treels_;
  double last_step_ = 0.0;  // [s]
};

}  // namespace cohort::physics
