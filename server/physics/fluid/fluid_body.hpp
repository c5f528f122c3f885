#pragma once

#include <memory>
#include <vector>

#include "server/physics/dynamics/equations.hpp"
#include "server/physics/fluid/fluid_model.hpp"

namespace cohort::physics {

/// What air and water do to one body, in every step: buoyancy, rotors, fins, drag and wind. Of different bodies from
/// different threads.
///
/// Buoyancy and thrust follow from where the body is and how its rotors turn, and act first. What depends on how the
/// body moves comes after them, one direction after the other, at the velocity to which it leads itself (implicit
/// Euler), without contacts and joints' motors: so it is stable at any step. So is buoyancy, whose change over the step
/// by the section at the surface is a damper of this kind.
class FluidBody {
 public:
  explicit FluidBody(std::shared_ptr<const FluidModel> model);

  /// Changes the velocities. May be called again for the same step.
  void apply(Equations& equations, const Media& media, double step);
  /// The step is done.
  void finish_step();
  /// The rotors stand still, until the next step.
  void stop();

  /// Sets the velocity that a rotor goes to. Returns false: that wakes no body, as one with rotors does not sleep.
  bool set_target(const DeviceOutputs::Propeller& rotor, double velocity) {
    rotors_[rotor.index].target = velocity;
    return false;
  }
  /// Returns what a rotor does, with the torque that it has in the fluid of its coefficients.
  OutputState state(const DeviceOutputs::Propeller& rotor) const;

  /// What acted in the last step, on a link at a point [N s, N m s].
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
    double after = 0.0;  // its velocity at the end of the present step
  };
  /// A place in the present step.
  struct Here {
    Pose X_WP;
    Media::Medium medium;
  };

  static Here here(const Place& place, const Equations& equations, const Media& media);
  static double share_of_density(double density, const Media::Medium& medium) {
    return density > 0.0 ? medium.density / density : 1.0;
  }

  void push_by_rotor(std::size_t index, Equations& equations, const Media& media, double step);
  void stiffen(const FluidModel::Float& floating, const SubmergedPart& part, const Media& media, Equations& equations,
               double step);
  void drag_rotor(std::size_t index, Equations& equations, const Media& media, double step);
  void push_fin(const FluidModel::FinPlace& placed, Equations& equations, const Media& media, double step);
  void damp(const FluidModel::DragPlace& placed, Equations& equations, const Media& media, double step);
  void blow(const FluidModel::Windage& windage, Equations& equations, const Media& media, double step);

  // The direction in which what follows acts: at a point of a place along a unit force or torque.
  void aim(const Place& place, const Eigen::Vector3d& point_W, const Spatial& unit_W, const Equations& equations);
  double velocity(const Equations& equations) const;
  double response(const Equations& equations);
  void push(double impulse, Equations& equations);
  void push(const Place& place, const Eigen::Vector3d& point_W, const Spatial& impulse_W, Equations& equations);
  /// Resists the velocity along it, against that of the fluid.
  void damp_along(double fluid_velocity, double linear, double quadratic, Equations& equations, double step);

  std::shared_ptr<const FluidModel> model_;
  std::vector<RotorState> rotors_;  // as those of the model
  std::vector<Impulse> impulses_;

  // Scratch memory.
  std::vector<SubmergedPart> submerged_;
  Impulse aimed_;  // of unit size
  std::vector<double> jacobian_;
  std::vector<double> response_;
};

}  // namespace cohort::physics
