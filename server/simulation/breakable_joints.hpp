#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort {

/// The breakable joints of a world, by their places in the description. That they hold, and what they bear, is part of
/// the state of the physics.
class BreakableJoints {
 public:
  /// Connects them, in a world where nothing is connected yet. What it refers to must outlive it.
  BreakableJoints(const description::World& description, physics::World& world);

  std::size_t size() const { return joints_.size(); }
  const std::string& name(std::size_t joint) const { return description_.breakable_joints[joint].name; }
  /// It has neither broken nor been released, which it is when one of its objects leaves the world or is moved.
  bool holds(std::size_t joint) const { return world_.connections().holds(joints_[joint].connection); }
  /// On the first link, about the place of the joint on it, over the last step; zero once it does not hold, but for the
  /// step that broke it.
  physics::Wrench wrench_on_first(std::size_t joint) const;
  /// The same on the second link.
  physics::Wrench wrench_on_second(std::size_t joint) const;
  /// Of each that the last step broke, a sentence.
  std::vector<std::string> broken() const;

 private:
  struct Connected {
    ConnectionId connection;
    bool is_swapped = false;  // its end a, which has to move, is on the second link
  };

  const description::World& description_;
  const physics::World& world_;
  std::vector<Connected> joints_;
};

}  // namespace cohort
