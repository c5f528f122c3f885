#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::gripping {

/// All detachable joints of a world and whether they hold. Commands come from one thread, between steps and in the
/// order of the robots; everything const may be asked from any thread between steps.
class DetachableJoints {
 public:
  /// Above this a joint is to hold [1].
  static constexpr double holding = 0.5;

  /// What it refers to must outlive it. An object that is not there is never held.
  DetachableJoints(const description::World& description, physics::World& world);

  /// A body has come, of one of the description's models: an instance of the description by now.
  void add_body(BodyId body, const description::Model& model);
  /// The number of the joint that is a device of a robot.
  std::uint32_t of_device(BodyId body, DeviceId device) const { return numbers_.at({body, device}); }

  /// Holds both links as they stand to each other, once both are in the world, or lets go. After what it held was torn
  /// away, by leaving the world or being moved, it holds again only once it has let go.
  void command(std::uint32_t joint, double attached);
  bool holds(std::uint32_t joint) const;

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  static constexpr ConnectionId nothing{0xffffffffu};
  static constexpr BodyId nobody{0xffffffffu};
  struct Joint {
    BodyId body;
    LinkId link;
    BodyId child = nobody;
    LinkId child_link{};
    ConnectionId connection = nothing;
    std::uint32_t is_spent = 0;  // 1: it lost what it held, and has not let go since
  };
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit);

  const description::World& description_;
  physics::World& world_;
  std::vector<Joint> joints_;
  std::map<std::pair<BodyId, DeviceId>, std::uint32_t> numbers_;
};

}  // namespace cohort::gripping
