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

/// What a gripper can grasp now.
struct Target {
  BodyId body;
  LinkId link;
  Eigen::Vector3d p_W;     ///< what it gives about: the middle of a ring, or the nearest place of a collision
  Eigen::Vector3d axis_W;  ///< of its ring, or that of the jaw; unit
  double distance = 0.0;   ///< from the jaw [m]
};

/// All grippers of a world and what they hold. Commands come from one thread, between steps and in the order of the
/// robots; everything const may be asked from any thread between steps.
class Grippers {
 public:
  /// From this opening on nothing is held [1].
  static constexpr double letting_go = 0.5;

  /// What it refers to must outlive it.
  Grippers(const description::World& description, physics::World& world);

  /// A body has come, of one of the description's models.
  void add_body(BodyId body, const description::Model& model);
  /// The number of the gripper that is a device of a robot.
  std::uint32_t of_device(BodyId body, DeviceId device) const { return numbers_.at({body, device}); }

  /// Moves the opening towards `opening` for one step, then grasps, holds or lets go. When it closes past half it
  /// grasps the nearest that is within its acceptance, and if there is nothing, what comes there while it is closed.
  /// After what it held was torn away or has left the world it grasps again only once it has been open.
  void command(std::uint32_t gripper, double opening);

  std::uint32_t size() const { return static_cast<std::uint32_t>(grippers_.size()); }
  Eigen::Vector3d place(std::uint32_t gripper) const {
    return jaw_pose(grippers_[gripper]).position;
  }  ///< of its jaw, p_W
  double opening(std::uint32_t gripper) const { return grippers_[gripper].opening; }
  bool is_gripping(std::uint32_t gripper) const;
  /// At the connection, over the last step [N]; 0 if it holds nothing.
  double force(std::uint32_t gripper) const;
  /// The light barrier.
  bool is_something_between(std::uint32_t gripper) const;
  /// The nearest within the acceptance; of two as near, that of the lower body, then link.
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
    std::uint32_t is_spent = 0;  // 1: it lost what it held, and has not been open since
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
  std::map<std::pair<BodyId, DeviceId>, std::uint32_t> numbers_;
};

}  // namespace cohort::gripping
