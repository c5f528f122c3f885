#pragma once

#include <vector>

#include "server/physics/mechanism/mechanism.hpp"
#include "server/physics/world/running_surface.hpp"

namespace cohort::physics {

/// The belts of one body: links whose surfaces run round them.
class Belts {
 public:
  /// Throws std::invalid_argument if two devices drive one link.
  explicit Belts(const Mechanism& mechanism);

  /// Of a link that has a belt [m/s]. Whether it is another one than before.
  bool set_velocity(std::size_t link, double velocity);
  /// How the surface of a link runs, which is in its segment at `X_WS`.
  RunningSurface of_link(std::size_t link, const std::vector<Pose>& X_WS) const;

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& belt : self.belts_) visit(belt.velocity);
  }

 private:
  struct RunningLink {
    std::size_t link = 0;
    std::size_t segment = 0;
    Eigen::Vector3d axis_S = Eigen::Vector3d::Zero();
    double velocity = 0.0;
  };
  std::vector<RunningLink> belts_;
};

}  // namespace cohort::physics
