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
#include "server/physics/world/motion_record.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/placed_body.hpp"
#include "server/physics/world/pushes.hpp"

namespace cohort::physics {

/// Bodies on flat ground, each with a position and a heading only: for large swarms. Height, roll and pitch stay as
/// they were when the body was placed. Against the full model:
///
/// - A body has the mass and the inertia of its model with all joints at zero. A VelocityMotor turns its joint as
///   commanded, within the joint's limits, whatever it meets; other joints stay where they are.
/// - Bodies run into each other and into walls by the outlines of their collisions, seen from above
///   (geometry::footprint_of), where these share heights. What is no upright prism, such as an ellipsoid or a mesh,
///   has the outline of geometry::Footprint. Links of one body do not touch each other.
/// - The ground is what was under the centre of mass when the body was placed, for ever: it gives friction, by half the
///   weight to each track, or by all of it to the lowest collision of a body without a drive, and is no contact.
///   Nothing falls, tips or climbs; a ball slides and does not roll; rolling resistance has no meaning.
/// - Connections hold in the plane: their wrench is a force in x and y and a torque about z. They are rigid, whatever
///   their ConnectionGive.
/// - Joints and motors have no force to tell; a motor that is told an effort stays where it is.
/// - There is no water, no wind, and nothing that flies or swims.
/// - The solver is always the iterative one.
class PlanarWorld final : public World {
 public:
  /// Throws std::invalid_argument for a world or a model that cannot be planar: gravity that is not along -z, water,
  /// ground that is not level, none under a body, a joint that moves against the world, a belt, a rotor, a fin, drag,
  /// a link that feels a wind, or a robot that leans by more than a milliradian. `like`: as make_world has it.
  PlanarWorld(const description::World& description, WorkerPool& workers, const PlanarWorld* like = nullptr);

  void step() override;
  std::span<const Quarantine> quarantined() const override { return quarantined_; }
  bool is_active(std::uint32_t body) const override;
  bool is_asleep(std::uint32_t) const override { return false; }
  std::uint32_t add_body(std::size_t model, const Pose& X_WM) override;
  void recreate_body(std::size_t model, const Pose& X_WM) override {
    create_body(model, X_WM);
    scene_.build();
  }
  void remove_body(std::uint32_t index) override;
  void put_back_body(std::uint32_t index) override;
  void place_body(std::uint32_t index, const Pose& X_WM) override;
  void push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) override;

  const geometry::Scene& scene() const override { return scene_; }
  std::size_t body_count() const override { return bodies_.size(); }
  std::size_t model_of(std::uint32_t body) const override { return bodies_[body].model; }
  Pose link_pose(std::uint32_t body, std::size_t link) const override;
  Twist link_twist(std::uint32_t body, std::size_t link) const override;
  double joint_position(std::uint32_t body, std::size_t joint) const override {
    return planar_.joint_position(bodies_[body].member, joint);
  }
  double joint_velocity(std::uint32_t body, std::size_t joint) const override {
    return planar_.joint_velocity(bodies_[body].member, joint);
  }
  TrackState track(std::uint32_t body, std::size_t, Side side) const override {
    return grounds_[bodies_[body].member].track(side);
  }
  void record(std::uint32_t body) override;
  Wrench joint_wrench(std::uint32_t, std::size_t) const override {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  }
  Eigen::Vector3d link_acceleration(std::uint32_t body, std::size_t link, const Eigen::Vector3d& p_LP) const override;
  double joint_effort(std::uint32_t, std::size_t) const override { return 0.0; }
  double driven_power(std::uint32_t body) const override;

  std::uint32_t connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                        std::size_t link_b, const ConnectionLimits& limits) override;
  void disconnect(std::uint32_t connection) override { connections_.release(connection); }
  bool is_connected(std::uint32_t connection) const override { return connections_.holds(connection); }
  void set_connection_give(std::uint32_t, const ConnectionGive&) override {}
  Wrench connection_wrench(std::uint32_t connection) const override;
  Wrench connection_reaction(std::uint32_t connection) const override;
  std::span<const std::uint32_t> broken_connections() const override { return connections_.broken(); }

  void set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) override {
    planar_.set_joint_target(bodies_[body].member, joint, JointRows::Control::velocity, velocity);
  }
  void set_joint_position_target(std::uint32_t body, std::size_t joint, double position) override {
    planar_.set_joint_target(bodies_[body].member, joint, JointRows::Control::position, position);
  }
  void set_joint_effort_target(std::uint32_t body, std::size_t joint, double effort) override {
    planar_.set_joint_target(bodies_[body].member, joint, JointRows::Control::effort, effort);
  }
  void set_track_velocity_target(std::uint32_t body, std::size_t, Side side, double velocity) override {
    grounds_[bodies_[body].member].set_target(side, velocity);
  }
  void set_belt_velocity_target(std::uint32_t, std::size_t, double) override {}     // none can be planar
  double rotor_velocity(std::uint32_t, std::size_t) const override { return 0.0; }  // none can be planar
  void set_rotor_velocity_target(std::uint32_t, std::size_t, double) override {}
  void set_root_twist(std::uint32_t body, const Twist& twist) override {
    planar_.set_root_twist(bodies_[body].member, twist);
  }
  void set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                       std::span<const double> velocities) override;

  std::span<const Contact> contacts() const override { return contacts_; }
  void hash_body(std::uint32_t body, StateHash& hash) const override;
  void hash_contacts(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;
  std::uint32_t connections_made() const override { return connections_.made(); }

 private:
  struct Member {  // a body that moves
    std::uint32_t body = 0;
    std::uint32_t first_part = 0;
    std::uint32_t part_count = 0;
    bool is_active = true;
    bool has_ground = false;  // or needs none
    // Of this step:
    bool is_finite = true;
    bool is_inside = true;
    std::unique_ptr<MotionRecord> record{};  // null: nobody asked for it
  };
  struct Part {  // a solid of a body that moves
    std::uint32_t solid = 0;
    int segment = 0;
    Pose X_SC;
    geometry::Footprint outline_B;
  };
  struct PartInBody {  // what is read in every step
    Pose X_BC;
    Eigen::Vector2d centre_B = Eigen::Vector2d::Zero();  // of the outline
    Eigen::Vector2d axis_B = Eigen::Vector2d::UnitX();
  };
  struct Before {  // what a solution changes at once, for the case that it is not good
    PlanarVelocity velocity;
    std::array<double, 3> ground_impulse{};
  };
  struct Memory {  // of one worker
    PlanarSolver solver;
    std::vector<std::uint32_t> members;
    std::vector<Before> before;
  };

  std::uint32_t create_body(std::size_t model, const Pose& X_WM);
  void add_static(std::uint32_t body);
  void add_moving(std::uint32_t body);
  void put_on_ground(std::uint32_t index);
  void place_on_ground(std::uint32_t member, const Pose& X_WM);
  void check_ground(const description::Model& described, const Pose& X_WM) const;
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
  Anchors::Part part_of(std::uint32_t solid) const { return part_of_solid_[solid]; }

  const description::World& description_;
  WorkerPool& workers_;
  double step_;
  SurfacePairs surfaces_;
  geometry::Scene scene_;
  std::vector<std::shared_ptr<const PlanarModel>> models_;  // null for what is static
  std::vector<PlacedBody> bodies_;
  std::vector<Member> members_;
  std::vector<Part> parts_;
  std::vector<PartInBody> parts_in_body_;  // of parts_
  std::vector<Anchors::Part> part_of_solid_;
  PlanarBodies planar_;
  std::vector<PlanarGround> grounds_;  // by member
  PlanarCollision collision_;
  Islands islands_;
  Connections connections_;
  std::vector<Contact> contacts_;
  std::vector<Quarantine> quarantined_;
  Pushes pushes_;
  std::vector<Memory> memory_;  // by worker
  bool has_records_ = false;
};

}  // namespace cohort::physics
