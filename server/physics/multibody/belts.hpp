// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/running_surface.hpp"

namespace cohort::physics {

/// The belts of one body: links whose surfaces move around them.
class Belts {
 public:
  /// Throws std::invalid_argument if two devices drive one link.
  explicit Belts(const Mechanism& mechanism);

  /// Sets the velocity of a belt [m/s]; returns whether it changed. Belts are numbered in the order of the devices.
  bool set_velocity(std::size_t belt, double velocity) {
    return std::exchange(belts_[belt].velocity, velocity) != velocity;
  }
  OutputState state(std::size_t belt) const { return {0.0, belts_[belt].velocity, belts_[belt].force}; }
  /// Returns the surface velocity of a link. `X_WS`: poses of the segments.
  RunningSurface of_link(std::size_t link, const std::vector<Pose>& X_WS) const;

  bool is_empty() const { return belts_.empty(); }
  void unload();
  /// Adds a force on a link [N] where its surface faces `outward_W`. Does nothing if the link has no belt.
  void load(std::size_t link, const std::vector<Pose>& X_WS, const Eigen::Vector3d& outward_W,
            const Eigen::Vector3d& force_W);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& belt : self.belts_) visit(belt.velocity);
  }
  /// Calls `visit` for each load of the last step, which the belts of sleeping bodies keep. Loads do not affect the
  /// further motion.
  template <class Self, class Visit>
  static void visit_loads(Self& self, Visit&& visit) {
    for (auto& belt : self.belts_) visit(belt.force);
  }

 private:
  struct RunningLink {
    std::size_t link = 0;
    std::size_t segment = 0;
    Eigen::Vector3d axis_S = Eigen::Vector3d::Zero();
    double velocity = 0.0;
    double force = 0.0;  // on its load, along its surface over the last step [N]
  };
  std::vector<RunningLink> belts_;
};

}  // namespace cohort::physics
