#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/islands/islands.hpp"
#include "server/physics/islands/large_island_solver.hpp"
#include "server/physics/islands/sleep.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/placed_body.hpp"

namespace cohort::physics {

/// One step of the bodies of a world: where they touch, which of them hang together, and, island by island, their
/// velocities under gravity, motors, joints and contacts and the way that these take them. Islands do not know of each
/// other, so it does not matter which worker has which.
class MultibodyWorld final : public World {
 public:
  /// `like`: as make_world has it.
  MultibodyWorld(const description::World& description, WorkerPool& workers, const MultibodyWorld* like = nullptr);

  void step() override;
  std::span<const Quarantine> quarantined() const override { return quarantined_; }
  bool is_active(std::uint32_t body) const override;
  bool is_asleep(std::uint32_t body) const override {
    return !is_static(body) && assembly_.members[bodies_[body].member].is_asleep;
  }
  std::uint32_t add_body(std::size_t model, const Pose& X_WM) override;
  void recreate_body(std::size_t model, const Pose& X_WM) override {
    create_body(model, X_WM);
    assembly_.scene.build();
  }
  void remove_body(std::uint32_t index) override;
  void put_back_body(std::uint32_t index) override;
  void place_body(std::uint32_t index, const Pose& X_WM) override;
  void push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) override;

  const geometry::Scene& scene() const override { return assembly_.scene; }
  std::size_t body_count() const override { return bodies_.size(); }
  std::size_t model_of(std::uint32_t body) const override { return bodies_[body].model; }
  Pose link_pose(std::uint32_t body, std::size_t link) const override;
  Twist link_twist(std::uint32_t body, std::size_t link) const override;
  double joint_position(std::uint32_t body, std::size_t joint) const override {
    return multibody(body).joint_position(joint);
  }
  double joint_velocity(std::uint32_t body, std::size_t joint) const override {
    return multibody(body).joint_velocity(joint);
  }
  TrackState track(std::uint32_t body, std::size_t drive, Side side) const override {
    return multibody(body).track(drive, side);
  }
  void record(std::uint32_t body) override {
    if (!is_static(body)) assembly_.record(wake(body).member);
  }
  Wrench joint_wrench(std::uint32_t body, std::size_t joint) const override;
  Eigen::Vector3d link_acceleration(std::uint32_t body, std::size_t link, const Eigen::Vector3d& p_LP) const override;
  double joint_effort(std::uint32_t body, std::size_t joint) const override {
    return is_static(body) ? 0.0 : multibody(body).joint_effort(joint);
  }
  double driven_power(std::uint32_t body) const override;

  std::uint32_t connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                        std::size_t link_b, const ConnectionLimits& limits) override;
  void disconnect(std::uint32_t number) override;
  std::uint32_t connections_made() const override { return assembly_.connections.made(); }
  bool is_connected(std::uint32_t connection) const override { return assembly_.connections.holds(connection); }
  void set_connection_give(std::uint32_t number, const ConnectionGive& give) override;
  Wrench connection_wrench(std::uint32_t number) const override;
  Wrench connection_reaction(std::uint32_t number) const override;
  std::span<const std::uint32_t> broken_connections() const override { return assembly_.connections.broken(); }

  void set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) override {
    set_joint_target(body, joint, JointRows::Control::velocity, velocity);
  }
  void set_joint_position_target(std::uint32_t body, std::size_t joint, double position) override {
    set_joint_target(body, joint, JointRows::Control::position, position);
  }
  void set_joint_effort_target(std::uint32_t body, std::size_t joint, double effort) override {
    set_joint_target(body, joint, JointRows::Control::effort, effort);
  }
  void set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) override {
    if (multibody(body).set_track_velocity_target(drive, side, velocity)) wake(body);
  }
  void set_belt_velocity_target(std::uint32_t body, std::size_t link, double velocity) override {
    if (multibody(body).set_belt_velocity(link, velocity)) wake(body);
  }
  double rotor_velocity(std::uint32_t body, std::size_t device) const override {
    return assembly_.members[bodies_[body].member].fluid->rotor_velocity(device);
  }
  void set_rotor_velocity_target(std::uint32_t body, std::size_t device, double velocity) override {
    assembly_.members[bodies_[body].member].fluid->set_rotor_target(device, velocity);
  }
  void set_root_twist(std::uint32_t body, const Twist& twist) override {
    wake(body);
    multibody(body).set_root_twist(twist);
  }
  void set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                       std::span<const double> velocities) override;

  std::span<const Contact> contacts() const override { return contacts_; }
  void hash_body(std::uint32_t body, StateHash& hash) const override;
  void hash_contacts(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;

 private:
  struct Memory {  // of one worker
    std::vector<std::uint32_t> near;
    std::vector<std::uint32_t> candidates;
    double furthest = 0.0;  // way of a part in this step [m]
  };

  std::unique_ptr<Multibody> make_multibody(std::size_t model, const Pose& X_WM, std::uint32_t body);
  std::uint32_t create_body(std::size_t model, const Pose& X_WM);
  void find_lowest();
  void find_awake();
  void detect();
  void find_islands();
  void solve_islands();
  void quarantine();
  void report_contacts();
  void report_contacts_of(std::uint32_t member);
  void wake_group_of(std::uint32_t sleeper);
  // Of a body that moves: it and what sleeps with it.
  PlacedBody& wake(std::uint32_t body);
  void set_joint_target(std::uint32_t body, std::size_t joint, JointRows::Control control, double target) {
    if (multibody(body).set_joint_target(joint, control, target)) wake(body);
  }
  // Of a body that moves.
  Multibody& multibody(std::uint32_t body) { return *assembly_.members[bodies_[body].member].multibody; }
  const Multibody& multibody(std::uint32_t body) const { return *assembly_.members[bodies_[body].member].multibody; }
  const ForceRecord* record_of(std::uint32_t body) const {
    return is_static(body) ? nullptr : assembly_.members[bodies_[body].member].record.get();
  }
  bool is_static(std::uint32_t body) const { return bodies_[body].member == Anchors::nobody; }

  const description::World& description_;
  WorkerPool& workers_;
  std::vector<std::shared_ptr<const Mechanism>> mechanisms_;             // by model, null for what is static
  std::vector<std::vector<std::shared_ptr<const BulletShape>>> shapes_;  // by model, of its collisions in their order
  std::vector<PlacedBody> bodies_;
  Assembly assembly_;
  Islands islands_;
  LargeIslandSolver large_island_solver_;
  std::vector<Contact> contacts_;
  std::vector<Quarantine> quarantined_;
  Sleep sleep_;
  std::vector<std::uint32_t> awake_;              // members, ascending
  std::vector<std::uint32_t> place_among_awake_;  // by member
  std::size_t contacts_asleep_ = 0;               // of contacts_, the first
  // Of the assembly, when awake_ was found and when contacts_ were.
  static constexpr std::uint64_t never = 0xffffffffffffffff;
  std::uint64_t awake_at_ = never;
  std::uint64_t reported_at_ = never;
  std::vector<Memory> memory_;  // by worker
};

}  // namespace cohort::physics
