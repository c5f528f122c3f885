// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/physics/islands/islands.hpp"
#include "server/physics/multibody/connections.hpp"
#include "server/physics/multibody/contact_rows.hpp"
#include "server/physics/planar/planar_collision.hpp"
#include "server/physics/planar/planar_ground.hpp"
#include "server/physics/planar/planar_solver.hpp"
#include "server/physics/world/body_slots.hpp"
#include "server/physics/world/motion_record.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/placed_body.hpp"
#include "server/physics/world/pushes.hpp"

namespace cohort::physics {

/// Bodies on flat ground, each with a position and a heading only, for large swarms. Height, roll and pitch stay as the
/// body was placed. Differences from the full model:
///
/// - A body has the mass and the inertia of its model with all joints at zero. A VelocityMotor turns its joint as
///   commanded within the joint's limits, regardless of obstacles. Other joints do not move.
/// - Bodies collide with each other and with walls if their heights overlap. Outlines are those of the collisions
///   seen from above (geometry::footprint_of). A shape that is not an upright prism, such as an ellipsoid or a mesh,
///   has the outline of geometry::Footprint. Links of one body do not collide with each other.
/// - The ground is the solid under the centre of mass when the body was placed, and never changes. Each track has
///   friction under half the weight. A body without a drive has friction under the whole weight, at its lowest
///   collision. The ground reports no contact. Nothing falls, tips or climbs. A ball slides and does not roll. Rolling
///   resistance has no effect.
/// - Connections hold in the plane. Their wrench is a force in x and y and a torque about z. They are rigid, with or
///   without a ConnectionGive.
/// - Joints and motors report no effort. A motor with an effort command does not move.
/// - There is no water, no wind, and nothing that flies or swims.
/// - The solver is always the iterative one.
class PlanarWorld final : public World, private WorldConnections {
 public:
  /// Throws std::invalid_argument for a world with water, gravity that is not along -z, ground that is not level, or a
  /// body without ground. Also throws for a model with a joint to the world that moves, a belt, a rotor, a fin, drag,
  /// or a link that feels wind. A robot must not lean by more than a milliradian. `like` and `X_WM`: as in make_world.
  PlanarWorld(const description::World& description, WorkerPool& workers, const PlanarWorld* like = nullptr,
              std::span<const Pose> X_WM = {});

  void step() override;
  std::span<const Quarantine> quarantined() const override { return quarantined_; }
  const Convergence& convergence() const override { return convergence_; }
  Activity activity(BodyId body) const override;
  BodyId add_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) override;
  void set_present(BodyId body, bool is_present) override;
  void release_body(BodyId body) override;
  std::uint32_t slot_of(BodyId body) const override { return bodies_[body.value].slot; }
  void place_body(BodyId index, const Pose& X_WM) override;
  void push_body(BodyId body, LinkId link, const Wrench& wrench) override;

  const geometry::Scene& scene() const override { return scene_; }
  std::size_t body_count() const override { return bodies_.size(); }
  std::size_t model_of(BodyId body) const override { return bodies_[body.value].model; }
  Pose link_pose(BodyId body, LinkId link) const override;
  Twist link_twist(BodyId body, LinkId link) const override;
  JointState joint_state(BodyId body, JointId joint) const override;
  OutputState device_state(BodyId body, DeviceId device, std::size_t output) const override;
  void record(BodyId body) override;
  Wrench joint_wrench(BodyId, JointId) const override { return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }
  Wrench joint_wrench_on_parent(BodyId body, JointId joint) const override { return joint_wrench(body, joint); }
  Eigen::Vector3d link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const override;

  WorldConnections& connections() override { return *this; }
  const WorldConnections& connections() const override { return *this; }

  void set_joint_target(BodyId body, JointId joint, const JointTarget& target) override {
    planar_.set_joint_target(bodies_[body.value].member, joint.value, target.kind, target.value);
  }
  void set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) override;
  void set_root_twist(BodyId body, const Twist& twist) override {
    planar_.set_root_twist(bodies_[body.value].member, twist);
  }
  void set_joint_state(BodyId body, JointId joint, std::span<const double> coordinates,
                       std::span<const double> velocities) override;

  std::span<const Contact> contacts() const override { return contacts_; }
  void hash_body(BodyId body, StateHash& hash) const override;
  void hash_contacts(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;

 private:
  ConnectionId connect(const BodyLink& a, const Pose& X_LP, const BodyLink& b, const ConnectionLimits& limits) override;
  void disconnect(ConnectionId connection) override { connections_.release(connection.value); }
  void set_give(ConnectionId, const ConnectionGive&) override {}
  std::uint32_t made() const override { return connections_.made(); }
  bool holds(ConnectionId connection) const override { return connections_.holds(connection.value); }
  Wrench wrench(ConnectionId connection, ConnectionEnd end) const override;
  std::span<const ConnectionId> broken() const override { return connections_.broken(); }

  struct Member {  // a moving body
    BodyId body;
    std::uint32_t first_part = 0;
    std::uint32_t part_count = 0;
    bool is_active = true;
    bool has_ground = false;  // or needs none
    // State of this step:
    bool is_finite = true;
    bool is_inside = true;
    std::unique_ptr<MotionRecord> record{};  // null: not requested
  };
  struct Part {  // a solid of a moving body
    std::uint32_t solid = 0;
    int segment = 0;
    Pose X_SC;
    geometry::Footprint outline_B;
  };
  struct PartInBody {  // data that is read in every step
    Pose X_BC;
    Eigen::Vector2d centre_B = Eigen::Vector2d::Zero();  // centre of the outline
    Eigen::Vector2d axis_B = Eigen::Vector2d::UnitX();
  };
  struct Before {  // data that a solution overwrites, restored if it is invalid
    PlanarVelocity velocity;
    std::array<double, 3> ground_impulse{};
  };
  struct Memory {  // scratch memory of one worker
    PlanarSolver solver;
    std::vector<std::uint32_t> members;
    std::vector<Before> before;
  };

  BodyId create_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot = {});
  void add_static(PlacedBody& body, BodyId id);
  void renew_static(const PlacedBody& body, BodyId id);
  void add_moving(PlacedBody& body, BodyId id);
  void renew_moving(const PlacedBody& body, BodyId id);
  void remove_body(BodyId body);
  void put_back_body(BodyId body);
  void put_on_ground(std::uint32_t index);
  void place_on_ground(std::uint32_t member, const Pose& X_WM);
  void check_new(const description::Model& described, const Pose& X_WM) const;
  void check_placed(const description::Model& model, const Pose& X_WM) const;
  bool needs_ground(const PlanarModel& model) const;
  std::uint32_t ground_under(const Eigen::Vector3d& origin_W) const;

  void find_islands();
  void solve_island(std::span<const std::uint32_t> members, Memory& memory);
  bool try_island(const std::vector<std::uint32_t>& members, Memory& memory);
  void add_rows_of(std::uint32_t member, PlanarSolver& solver);
  void move(std::uint32_t index);
  void find_parts_in_body(const Member& member, std::uint32_t index);
  void expect_sound(std::uint32_t member) const;
  void place_solids(std::uint32_t index);
  Pose pose_of(const Connection::End& end) const;
  void report_contacts();
  void quarantine();
  void take_out(std::uint32_t index);
  Side side_of(std::uint32_t member, DeviceId device, std::size_t output) const;
  Anchors::Part part_of(std::uint32_t solid) const { return part_of_solid_[solid]; }

  const description::World& description_;
  WorkerPool& workers_;
  double step_;
  SurfacePairs surfaces_;
  geometry::Scene scene_;
  std::vector<std::shared_ptr<const PlanarModel>> models_;  // null for static models
  geometry::SolidKinds kinds_;
  std::vector<PlacedBody> bodies_;
  BodySlots slots_;
  std::vector<Member> members_;
  std::vector<Part> parts_;
  std::vector<PartInBody> parts_in_body_;  // by part, as parts_
  std::vector<Anchors::Part> part_of_solid_;
  PlanarBodies planar_;
  std::vector<PlanarGround> grounds_;  // by member
  PlanarCollision collision_;
  Islands islands_;
  Connections connections_;
  std::vector<Contact> contacts_;
  std::vector<Quarantine> quarantined_;
  Convergence convergence_;
  Pushes pushes_;
  std::vector<Memory> memory_;  // by worker
  bool has_records_ = false;
};

}  // namespace cohort::physics
