// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/islands/islands.hpp"
#include "server/physics/islands/large_island_solver.hpp"
#include "server/physics/islands/sleep.hpp"
#include "server/physics/world/body_slots.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/placed_body.hpp"

namespace cohort::physics {

/// The bodies of a world and their step: it finds contacts and islands, then solves each island for its velocities
/// under gravity, motors, joints and contacts, and moves the bodies. Islands are independent, so the result does not
/// depend on which worker solves which.
class MultibodyWorld final : public World, private WorldConnections {
 public:
  /// `like` and `X_WM`: as in make_world.
  MultibodyWorld(const description::World& description, WorkerPool& workers, const MultibodyWorld* like = nullptr,
                 std::span<const Pose> X_WM = {});

  void step() override;
  std::span<const Quarantine> quarantined() const override { return quarantined_; }
  const Convergence& convergence() const override { return convergence_; }
  Activity activity(BodyId body) const override;
  BodyId add_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) override;
  void set_present(BodyId body, bool is_present) override;
  void release_body(BodyId index) override;
  std::uint32_t slot_of(BodyId body) const override { return bodies_[body.value].slot; }
  void place_body(BodyId index, const Pose& X_WM) override;
  void push_body(BodyId body, LinkId link, const Wrench& wrench) override;

  const geometry::Scene& scene() const override { return assembly_.scene; }
  std::size_t body_count() const override { return bodies_.size(); }
  std::size_t model_of(BodyId body) const override { return bodies_[body.value].model; }
  Pose link_pose(BodyId body, LinkId link) const override;
  Twist link_twist(BodyId body, LinkId link) const override;
  JointState joint_state(BodyId body, JointId joint) const override;
  OutputState device_state(BodyId body, DeviceId device, std::size_t output) const override;
  void record(BodyId body) override {
    if (!is_static(body)) assembly_.record(wake(body).member);
  }
  Wrench joint_wrench(BodyId body, JointId joint) const override;
  Wrench joint_wrench_on_parent(BodyId body, JointId joint) const override;
  Eigen::Vector3d link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const override;

  WorldConnections& connections() override { return *this; }
  const WorldConnections& connections() const override { return *this; }

  void set_joint_target(BodyId body, JointId joint, const JointTarget& target) override {
    if (multibody(body).set_joint_target(joint.value, target.kind, target.value)) wake(body);
  }
  void set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) override;
  void set_root_twist(BodyId body, const Twist& twist) override {
    wake(body);
    multibody(body).motion().set_root_twist(twist);
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
  void disconnect(ConnectionId connection) override;
  void set_give(ConnectionId connection, const ConnectionGive& give) override;
  std::uint32_t made() const override { return assembly_.connections.made(); }
  bool holds(ConnectionId connection) const override { return assembly_.connections.holds(connection.value); }
  Wrench wrench(ConnectionId connection, ConnectionEnd end) const override;
  std::span<const ConnectionId> broken() const override { return assembly_.connections.broken(); }

  struct Memory {  // scratch memory of one worker
    std::vector<std::uint32_t> near;
    std::vector<std::uint32_t> candidates;
    double furthest = 0.0;  // greatest displacement of a part in this step [m]
  };

  std::unique_ptr<Multibody> make_multibody(std::size_t model, const Pose& X_WM, BodyId body);
  BodyId create_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot = {});
  const ModelParts& parts_of(std::size_t model);
  void remove_body(BodyId index);
  void put_back_body(BodyId index);
  void find_lowest();
  void find_awake();
  void detect();
  void find_islands();
  void solve_islands();
  void count_outcomes();
  void quarantine();
  void report_contacts();
  void report_contacts_of(std::uint32_t member);
  void wake_group_of(std::uint32_t sleeper);
  // Wakes a moving body and those that fell asleep with it.
  PlacedBody& wake(BodyId body);
  // The body must be a moving one.
  Multibody& multibody(BodyId body) { return *assembly_.members[bodies_[body.value].member].multibody; }
  const Multibody& multibody(BodyId body) const { return *assembly_.members[bodies_[body.value].member].multibody; }
  const ForceRecord* record_of(BodyId body) const {
    return is_static(body) ? nullptr : assembly_.members[bodies_[body.value].member].record.get();
  }
  bool is_static(BodyId body) const { return bodies_[body.value].member == Anchors::nobody; }

  const description::World& description_;
  WorkerPool& workers_;
  std::vector<std::shared_ptr<const Mechanism>> mechanisms_;  // by model, null for a static one
  std::vector<std::shared_ptr<const ModelParts>> parts_;      // by model, null for one without bodies so far
  geometry::SolidKinds kinds_;
  std::vector<PlacedBody> bodies_;
  BodySlots slots_;
  Assembly assembly_;
  Islands islands_;
  LargeIslandSolver large_island_solver_;
  std::vector<Contact> contacts_;
  std::vector<Quarantine> quarantined_;
  std::vector<std::optional<Convergence::Outcome>> outcomes_;  // by island
  Convergence convergence_;
  Sleep sleep_;
  std::vector<std::uint32_t> awake_;              // members, ascending
  std::vector<std::uint32_t> place_among_awake_;  // by member
  std::size_t contacts_asleep_ = 0;               // that many first elements of contacts_
  // Revision of the assembly for which awake_ was computed, and contacts_.
  static constexpr std::uint64_t never = 0xffffffffffffffff;
  std::uint64_t awake_at_ = never;
  std::uint64_t reported_at_ = never;
  bool is_lowest_known_ = false;  // no body was added, moved or released since the lowest height was set
  std::vector<Memory> memory_;    // by worker
};

}  // namespace cohort::physics
