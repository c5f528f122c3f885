// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {

/// The settings of physics: the parameter of tests that apply to every kind of physics.
struct Physics {
  description::Fidelity fidelity = description::Fidelity::treel;
  description::Solver solver = description::PhysicsSettings{}.solver;
  description::Dynamics dynamics = description::Dynamics::cohort;

  bool operator==(const Physics&) const = default;
  std::string name() const {
    const std::string solvers[] = {"_iterative", "", "_direct", "_hybrid"};
    const std::string fidelities[] = {"articulated", "treel", "planar"};
    return fidelities[static_cast<std::size_t>(fidelity)] + solvers[static_cast<std::size_t>(solver)] +
           (dynamics == description::Dynamics::bullet ? "_bullet" : "");
  }
  /// Returns a world with only a floor.
  description::World world(double friction = 1.0) const {
    description::World world = world_with_floor(friction);
    world.physics.fidelity = fidelity;
    world.physics.solver = solver;
    world.physics.dynamics = dynamics;
    return world;
  }
  /// Returns `tracked_robot`; with `articulated` fidelity, it has wheels that its drive turns.
  description::Model robot() const {
    description::Model model = tracked_robot();
    if (fidelity != description::Fidelity::articulated) return model;
    auto& drive = std::get<description::TreelDrive>(model.devices[0]);
    for (const double y : {drive.half_gauge, -drive.half_gauge})
      for (const double x : {drive.half_contact_length, -drive.half_contact_length})
        (y > 0.0 ? drive.left_wheels : drive.right_wheels)
            .push_back(add_wheel(model, {x, y, drive.wheel_radius}, drive.wheel_radius, 0.01, 0.02));
    return model;
  }
};
inline void PrintTo(const Physics& physics, std::ostream* out) { *out << physics.name(); }
inline std::string name_of(const ::testing::TestParamInfo<Physics>& info) { return info.param.name(); }

using EveryPhysics = ::testing::TestWithParam<Physics>;

/// Returns the same settings with Bullet's dynamics.
constexpr Physics by_bullet(Physics physics) {
  physics.dynamics = description::Dynamics::bullet;
  return physics;
}

inline constexpr Physics articulated{description::Fidelity::articulated}, treel{description::Fidelity::treel},
    iterative{description::Fidelity::treel, description::Solver::iterative},
    direct{description::Fidelity::treel, description::Solver::direct},
    hybrid{description::Fidelity::treel, description::Solver::hybrid}, planar{description::Fidelity::planar};
inline const auto every_physics = ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel),
                                                    hybrid, by_bullet(iterative), planar);

}  // namespace cohort::test
