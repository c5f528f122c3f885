// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "server/physics/dynamics/equations.hpp"
#include "server/physics/fluid/fluid_model.hpp"

namespace cohort::physics {

/// Applies the forces of air and water to one body in every step: buoyancy, rotors, fins, drag and wind. Threads may
/// work on different bodies.
///
/// Buoyancy and thrust depend on the pose of the body and the speed of its rotors, and act first. Forces that depend on
/// the velocity follow, one direction after the other. Each is evaluated at the velocity that results from it (implicit
/// Euler), without contacts and joint motors, and is therefore stable at any step size. Buoyancy is stable too: its
/// change over the step, given by the waterplane area and the metacentric height, acts as such a damper.
class FluidBody {
 public:
  explicit FluidBody(std::shared_ptr<const FluidModel> model);

  /// Changes the velocities. May be called again for the same step.
  void apply(Equations& equations, const Media& media, double step);
  /// Ends the step: rotors take their new velocities.
  void finish_step();
  /// Stops the rotors until the next step.
  void stop();

  /// Sets the target velocity of a rotor. Returns false (no body has to wake), because a body with rotors never sleeps.
  bool set_target(const DeviceOutputs::Propeller& rotor, double velocity) {
    rotors_[rotor.index].target = velocity;
    return false;
  }
  /// Returns the state of a rotor, with its torque in the fluid for which its coefficients hold.
  OutputState state(const DeviceOutputs::Propeller& rotor) const;

  /// An impulse on a link at a point in the last step [N s, N m s].
  struct Impulse {
    std::size_t link = 0;
    Eigen::Vector3d point_W;
    Spatial impulse_W;
  };
  const std::vector<Impulse>& impulses() const { return impulses_; }

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& rotor : self.rotors_) {
      visit(rotor.velocity);
      visit(rotor.target);
    }
  }

 private:
  using Place = FluidModel::Place;

  struct RotorState {
    double velocity = 0.0;  // [rad/s]
    double target = 0.0;
    double after = 0.0;  // velocity at the end of this step
  };
  /// The pose of a place and the medium there in this step.
  struct Here {
    Pose X_WP;
    Media::Medium medium;
  };

  static Here here(const Place& place, const Equations& equations, const Media& media);
  static double share_of_density(double density, const Media::Medium& medium) {
    return density > 0.0 ? medium.density / density : 1.0;
  }

  void push_by_rotor(std::size_t index, Equations& equations, const Media& media, double step);
  void stiffen(const Place& link, const SubmergedPart& part, const Media& media, Equations& equations, double step);
  void drag_rotor(std::size_t index, Equations& equations, const Media& media, double step);
  void push_fin(const FluidModel::FinPlace& placed, Equations& equations, const Media& media, double step);
  void damp(const FluidModel::DragPlace& placed, Equations& equations, const Media& media, double step);
  void blow(const FluidModel::Windage& windage, Equations& equations, const Media& media, double step);

  // Sets the direction of the following calls: a unit force or torque at a point of a place.
  void aim(const Place& place, const Eigen::Vector3d& point_W, const Spatial& unit_W, const Equations& equations);
  double velocity(const Equations& equations) const;
  double response(Equations& equations);
  void push(double impulse, Equations& equations);
  void push(const Place& place, const Eigen::Vector3d& point_W, const Spatial& impulse_W, Equations& equations);
  /// Applies damping along this direction, relative to the velocity of the fluid.
  void damp_along(double fluid_velocity, double linear, double quadratic, Equations& equations, double step);

  std::shared_ptr<const FluidModel> model_;
  std::vector<RotorState> rotors_;  // in the order of the model's
  std::vector<Impulse> impulses_;

  // Scratch memory.
  std::vector<SubmergedPart> submerged_;
  Impulse aimed_;  // unit impulse
  std::vector<double> jacobian_;
  std::vector<double> response_;
};

}  // namespace cohort::physics
