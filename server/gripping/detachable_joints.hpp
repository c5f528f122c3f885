// SPDX-License-Identifier: Apache-2.0
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

/// All detachable joints of a world, and whether they hold. Commands come from one thread, between steps and in the
/// order of the robots; const functions may be called from any thread between steps.
class DetachableJoints {
 public:
  /// A command above this threshold attaches the joint [1].
  static constexpr double holding = 0.5;

  /// The arguments must outlive this object. A joint to an unknown object never holds.
  DetachableJoints(const description::World& description, physics::World& world);

  /// Adds a new body with one of the description's models, which is already an instance of the description.
  void add_body(BodyId body, const description::Model& model);
  /// Returns the index of the joint that is a device of a robot.
  std::uint32_t of_device(BodyId body, DeviceId device) const { return numbers_.at({world_.slot_of(body), device}); }

  /// Fixes both links in their current relative pose, once both are in the world, or releases them. If the held object
  /// leaves the world or is moved away, the joint must be released before it can hold again.
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
    std::uint32_t is_spent = 0;  // 1: it lost its object, and was not released since
  };
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit);

  const description::World& description_;
  physics::World& world_;
  std::vector<Joint> joints_;
  std::map<std::pair<std::uint32_t, DeviceId>, std::uint32_t> numbers_;  // by slot of the body and device
};

}  // namespace cohort::gripping
