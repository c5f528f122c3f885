#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/physics/collision.hpp"
#include "server/physics/connection.hpp"
#include "server/physics/contact_rows.hpp"
#include "server/physics/engine.hpp"
#include "server/physics/islands.hpp"
#include "server/physics/multibody.hpp"
#include "server/physics/world.hpp"

namespace cohort::physics {

/// One step of the bodies of a world: where they touch, which of them hang together, and, island by island, their
/// velocities under gravity, motors, joints and contacts and the way that these take them. Islands do not know of each
/// other, so it does not matter which worker has which.
class Stepper final : public Engine {
 public:
  Stepper(const description::World& description, WorkerPool& workers);

  void step() override;
  std::span<const Quarantine> quarantined() const override { return quarantined_; }
  bool is_active(std::uint32_t body) const override;
  std::uint32_t add_body(std::size_t model, const Pose& X_WM) override;
  void remove_body(std::uint32_t body) override;
  void put_back_body(std::uint32_t body) override;
  void place_body(std::uint32_t body, const Pose& X_WM) override;
  void push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) override;

  const geometry::Scene& scene() const override { return scene_; }
  std::size_t body_count() const override { return bodies_.size(); }
  Pose link_pose(std::uint32_t body, std::size_t link) const override;
  Twist link_twist(std::uint32_t body, std::size_t link) const override;
  double joint_position(std::uint32_t body, std::size_t joint) const override {
    return bodies_[body].multibody->joint_position(joint);
  }
  double joint_velocity(std::uint32_t body, std::size_t joint) const override {
    return bodies_[body].multibody->joint_velocity(joint);
  }
  TrackState track(std::uint32_t body, std::size_t drive, Side side) const override {
    return bodies_[body].multibody->track(drive, side);
  }

  std::uint32_t connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                        std::size_t link_b, const ConnectionLimits& limits) override;
  void disconnect(std::uint32_t connection) override { connections_[connection].release(); }
  bool is_connected(std::uint32_t connection) const override { return connections_[connection].holds(); }
  Wrench connection_wrench(std::uint32_t connection) const override { return connections_[connection].wrench(step_); }
  std::span<const std::uint32_t> broken_connections() const override { return broken_; }

  void set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) override {
    bodies_[body].multibody->set_joint_velocity_target(joint, velocity);
  }
  void set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) override {
    bodies_[body].multibody->set_track_velocity_target(drive, side, velocity);
  }
  void set_root_twist(std::uint32_t body, const Twist& twist) override {
    bodies_[body].multibody->set_root_twist(twist);
  }
  void set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                       std::span<const double> velocities) override;

  std::span<const Contact> contacts() const override { return contacts_; }
  void hash_body(std::uint32_t body, StateHash& hash) const override;
  void hash_contacts(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;

 private:
  struct Part {  // a solid of a body that moves
    std::uint32_t solid = 0;
    int segment = 0;
    Pose X_SC;
  };
  struct Body {
    std::size_t model = 0;
    Pose X_WM;  // where it was placed; a static body is there
    std::uint32_t member = Anchors::nobody;
    std::unique_ptr<Multibody> multibody;  // null for what is static
    bool is_placed_again = false;          // X_WM is not what the description says
    bool is_out = false;                   // of what is static
    std::vector<std::uint32_t> solids{};   // of what is static
  };
  struct Push {
    std::uint32_t member = 0;
    int segment = 0;
    Eigen::Vector3d point_W;
    Wrench wrench;
  };
  struct Member {  // a body that moves
    std::uint32_t body = 0;
    std::vector<Part> parts;                   // ascending solids
    std::vector<std::uint32_t> connections{};  // whose end a is here, ascending
    bool is_active = true;
    // Of this step:
    bool is_finite = true;
    bool is_inside = true;
  };
  struct Memory {  // of one worker
    Problem problem;
    std::vector<std::uint32_t> near;
    std::vector<std::uint32_t> candidates;
    std::vector<std::uint32_t> members;
  };

  std::uint32_t create_body(std::size_t model, const Pose& X_WM);
  void add_solid(std::uint32_t body, const description::Collision& collision, const Pose& X_WC, Anchors::Part part,
                 std::shared_ptr<const BulletShape> shape);
  void add_static_solids(std::uint32_t body);
  void add_moving_solids(std::uint32_t body);
  void find_lowest();
  bool may_touch(std::uint32_t solid, std::uint32_t other) const;
  void detect();
  void look_around(const Member& member, Memory& memory);
  void find_islands();
  void solve_island(std::span<const std::uint32_t> members, Memory& memory);
  bool try_island(const std::vector<std::uint32_t>& members, Problem& problem);
  void add_connection_rows_of(const Member& member, Problem& problem);
  void break_connections();
  void quarantine();
  void take_out(Member& member);
  void release_connections_of(std::uint32_t member);
  void add_pushes_of(std::uint32_t member, Problem& problem) const;
  void solve(Problem& problem) const;
  void place_solids_of(const Member& member);
  void add_contact_rows_of(const Member& member, Problem& problem);
  void report_contacts();
  Multibody& of(const Member& member) { return *bodies_[member.body].multibody; }
  const Multibody& of(const Member& member) const { return *bodies_[member.body].multibody; }

  const description::World& description_;
  WorkerPool& workers_;
  double step_;
  double lowest_ = 0.0;  // a body below this has left the world
  SurfacePairs surfaces_;
  geometry::Scene scene_;
  std::vector<std::unique_ptr<Mechanism>> mechanisms_;                   // by model, null for what is static
  std::vector<std::vector<std::shared_ptr<const BulletShape>>> shapes_;  // by model, of its collisions in their order
  std::vector<Body> bodies_;
  std::vector<Member> members_;
  Anchors anchors_;
  Collision collision_;
  Islands islands_;
  std::vector<Connection> connections_;
  std::vector<std::uint32_t> broken_;
  std::vector<Contact> contacts_;
  std::vector<Quarantine> quarantined_;
  std::vector<Push> pushes_;    // of the next step, by member
  std::vector<Memory> memory_;  // by worker
};

}  // namespace cohort::physics
