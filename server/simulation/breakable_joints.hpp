// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort {

/// The breakable joints of a world, by their index in the description. Their connections and loads are part of the
/// state of the physics.
class BreakableJoints {
 public:
  /// Connects the joints, in a world without connections. The arguments must outlive this object.
  BreakableJoints(const description::World& description, physics::World& world);

  std::size_t size() const { return joints_.size(); }
  const std::string& name(std::size_t joint) const { return description_.breakable_joints[joint].name; }
  /// Returns true if the joint has neither broken nor been released. It is released when one of its objects leaves the
  /// world or is moved.
  bool holds(std::size_t joint) const { return world_.connections().holds(joints_[joint].connection); }
  /// Returns the wrench on the first link over the last step, about the joint's position on that link. It is zero once
  /// the joint no longer holds, except for the step that broke the joint.
  physics::Wrench wrench_on_first(std::size_t joint) const;
  /// Returns the wrench on the second link, in the same way.
  physics::Wrench wrench_on_second(std::size_t joint) const;
  /// Returns a sentence for each joint that the last step broke.
  std::vector<std::string> broken() const;

 private:
  struct Connected {
    ConnectionId connection;
    bool is_swapped = false;  // end a, which must be on the moving link, is on the second link
  };

  const description::World& description_;
  const physics::World& world_;
  std::vector<Connected> joints_;
};

}  // namespace cohort
