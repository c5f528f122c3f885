// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::gripping {

/// An object that a gripper can grasp now.
struct Target {
  BodyId body;
  LinkId link;
  Eigen::Vector3d p_W;     ///< centre of rotation: the middle of a ring, or the nearest point of a collision
  Eigen::Vector3d axis_W;  ///< unit axis of its ring, or of the jaw
  double distance = 0.0;   ///< distance from the jaw [m]
};

/// All grippers of a world and the objects that they hold. Commands come from one thread, between steps and in the
/// order of the robots; const functions may be called from any thread between steps.
class Grippers {
 public:
  /// A gripper releases its object when its opening reaches this value [1].
  static constexpr double letting_go = 0.5;

  /// The arguments must outlive this object.
  Grippers(const description::World& description, physics::World& world);

  /// Adds a new body with one of the description's models.
  void add_body(BodyId body, const description::Model& model);
  /// Returns the index of the gripper that is a device of a robot.
  std::uint32_t of_device(BodyId body, DeviceId device) const { return numbers_.at({world_.slot_of(body), device}); }

  /// Moves the opening towards `opening` for one step, then grasps, holds or releases. When the opening falls below
  /// `letting_go`, the gripper grasps the nearest object within its acceptance region, or the first one that enters
  /// this region while the gripper is closed. If the held object is torn away or leaves the world, the gripper must
  /// open before it can grasp again.
  void command(std::uint32_t gripper, double opening);

  std::uint32_t size() const { return static_cast<std::uint32_t>(grippers_.size()); }
  Eigen::Vector3d place(std::uint32_t gripper) const {
    return jaw_pose(grippers_[gripper]).position;
  }  ///< position of its jaw, p_W
  double opening(std::uint32_t gripper) const { return grippers_[gripper].opening; }
  bool is_gripping(std::uint32_t gripper) const;
  /// Returns the magnitude of the force at the connection over the last step [N]; 0 if the gripper holds nothing.
  double force(std::uint32_t gripper) const;
  /// Returns the state of the light barrier.
  bool is_something_between(std::uint32_t gripper) const;
  /// Returns the nearest object within the acceptance region. If two are at the same distance, the lower body id
  /// decides, then the lower link id.
  std::optional<Target> find_target(std::uint32_t gripper) const;

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  static constexpr ConnectionId nothing{0xffffffffu};
  struct Gripper {
    BodyId body;
    const description::Gripper* device = nullptr;
    double opening = 1.0;
    ConnectionId connection = nothing;
    std::uint32_t is_spent = 0;  // 1: it lost its object, and has not opened since
  };
  Pose jaw_pose(const Gripper& gripper) const;
  void grasp(Gripper& gripper, const Target& target);
  void set_give(const Gripper& gripper);
  void consider_rings(const Gripper& gripper, const Pose& X_WG, BodyId body, std::optional<Target>& best) const;
  void consider_solid(const Gripper& gripper, const Pose& X_WG, std::uint32_t index, std::optional<Target>& best) const;
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit);

  const description::World& description_;
  physics::World& world_;
  double step_;
  double largest_ring_ = 0.0;
  std::vector<Gripper> grippers_;
  std::map<std::pair<std::uint32_t, DeviceId>, std::uint32_t> numbers_;  // by slot of the body and device
};

}  // namespace cohort::gripping
