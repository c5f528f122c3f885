// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/random.hpp"
#include "tests/support/worlds/lifting.hpp"

namespace cohort::test {

/// Robots on a slightly disturbed square grid, each of which grips some of its neighbours in their present poses.
struct GrippedSwarm {
  struct Grip {
    ConnectionId connection;
    BodyId a, b;
    Pose X_Pa, X_Pb;  // the connection's frame P in the gripping link of a and in the turret of b
  };
  static constexpr int side = 5;

  SmallWorld small;
  std::size_t gripping_link;
  std::vector<BodyId> robots;
  std::vector<Grip> grips;
  RandomStream random;

  /// With arms, robots grip with the arm, otherwise with the turret.
  GrippedSwarm(description::Solver solver, std::uint64_t seed, bool with_arms, double rotor_inertia = 0.0)
      : gripping_link(with_arms ? arm_link : turret), random(seed, "swarm", "drive") {
    small.description.physics.solver = solver;
    const double spacing = with_arms ? 0.19 : 0.135;
    std::uint32_t draw = 0;
    const auto off = [&](double by) { return by * (2.0 * random.uniform(0, draw++) - 1.0); };
    for (int i = 0; i < side * side; ++i) {
      const int column = i % side, row = i / side;
      robots.push_back(small.add(
          with_arms ? with_arm(2.0, 0.05, rotor_inertia) : tracked_robot(),
          at(spacing * column + off(0.005), spacing * row + off(0.005), 0, with_arms ? off(0.05) : off(3.0))));
    }
    // Turrets grip one or two of the neighbours to the right and behind; arms reach only to the right.
    for (int i = 0; i < side * side; ++i) {
      const bool has_right = i % side + 1 < side;
      const bool has_behind = i / side + 1 < side;
      const double choice = random.uniform(0, draw++);
      if (has_right && (with_arms || choice < 0.7)) grip(robots[i], robots[i + 1]);
      if (has_behind && !with_arms && (choice > 0.4 || !has_right)) grip(robots[i], robots[i + side]);
      if (has_behind && with_arms && choice < 0.3) grip(robots[i], robots[i + side], turret);
    }
  }
  void grip(BodyId a, BodyId b) { grip(a, b, gripping_link); }
  void grip(BodyId a, BodyId b, std::size_t link) {
    physics::World& world = small.world();
    const Pose X_WLa = world.link_pose(a, LinkId{link});
    const Pose X_WLb = world.link_pose(b, LinkId{turret});
    // The grip is at the jaw, or halfway between the turrets.
    const Eigen::Vector3d p_W =
        link == turret ? Eigen::Vector3d(0.5 * (X_WLa.position + X_WLb.position) + Eigen::Vector3d(0, 0, 0.02))
                       : Eigen::Vector3d(X_WLa * Eigen::Vector3d(arm_length, 0, 0));
    const Pose X_WP{p_W, X_WLa.orientation};
    const Pose X_LP = X_WLa.inverse() * X_WP;
    grips.push_back({world.connections().connect({a, LinkId{link}}, X_LP, {b, LinkId{turret}}), a, b, X_LP,
                     X_WLb.inverse() * X_WP});
    links.push_back(link);
  }
  std::vector<std::size_t> links;  // links of the grips, at a

  void drive(int tick) {
    const int every = 200;
    if (tick % every != 0) return;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto draw = static_cast<std::uint32_t>(4 * i);
      const auto period = 1 + static_cast<std::uint64_t>(tick / every);
      small.drive(robots[i], 0.4 * random.uniform(period, draw) - 0.2, 0.4 * random.uniform(period, draw + 1) - 0.2);
      small.world().set_joint_target(robots[i], JointId{0},
                                     physics::JointTarget::velocity(3.0 * random.uniform(period, draw + 2) - 1.5));
      if (gripping_link == arm_link)
        small.world().set_joint_target(robots[i], JointId{elevation_joint},
                                       physics::JointTarget::position(0.4 * random.uniform(period, draw + 3) - 0.2));
    }
  }
  /// Returns the largest distance between the two ends of a grip [m].
  double gap() {
    double greatest = 0.0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const Grip& grip = grips[i];
      const Eigen::Vector3d a = small.world().link_pose(grip.a, LinkId{links[i]}) * grip.X_Pa.position;
      const Eigen::Vector3d b = small.world().link_pose(grip.b, LinkId{turret}) * grip.X_Pb.position;
      greatest = std::max(greatest, (a - b).norm());
    }
    return greatest;
  }
  double greatest_speed() {
    double greatest = 0.0;
    for (const BodyId robot : robots) greatest = std::max(greatest, small.velocity(robot, turret).norm());
    return greatest;
  }
  double greatest_height() {
    double greatest = 0.0;
    for (const BodyId robot : robots) greatest = std::max(greatest, small.position(robot).z());
    return greatest;
  }
};

}  // namespace cohort::test
