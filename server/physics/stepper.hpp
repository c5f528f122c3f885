#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/physics/collision.hpp"
#include "server/physics/contact_rows.hpp"
#include "server/physics/islands.hpp"
#include "server/physics/multibody.hpp"
#include "server/physics/world.hpp"

namespace cohort::physics {

/// One step of the bodies of a world: where they touch, which of them hang together, and, island by island, their
/// velocities under gravity, motors, joints and contacts and the way that these take them. Islands do not know of each
/// other, so it does not matter which worker has which.
class Stepper {
 public:
  Stepper(const description::World& description, WorkerPool& workers);

  void step();

  const geometry::Scene& scene() const { return scene_; }
  std::size_t body_count() const { return multibodies_.size(); }
  /// Null if the body is static.
  Multibody* multibody(std::uint32_t body) { return multibodies_[body].get(); }
  const Multibody* multibody(std::uint32_t body) const { return multibodies_[body].get(); }
  Pose resting_link_pose(std::uint32_t body, std::size_t link) const;
  /// Takes a body's poses into the scene.
  void place_solids(std::uint32_t body);
  std::span<const Contact> contacts() const { return contacts_; }
  void hash_contacts(StateHash& hash) const;

 private:
  struct Part {  // a solid of a body that moves
    std::uint32_t solid = 0;
    int segment = 0;
    Pose X_SC;
  };
  struct Member {
    std::uint32_t body = 0;
    std::vector<Part> parts;  // ascending solids
  };
  struct Memory {  // of one worker
    Problem problem;
    std::vector<std::uint32_t> near;
  };

  void add_body(std::uint32_t body);
  void add_static_solids(std::uint32_t body);
  bool may_touch(std::uint32_t solid, std::uint32_t other) const;
  void find_ground();
  void find_islands();
  void solve_island(std::span<const std::uint32_t> members, Memory& memory);
  void solve(Problem& problem) const;
  void place_solids_of(const Member& member);
  void add_contact_rows_of(const Member& member, Problem& problem);
  void report_contacts();
  Multibody& of(const Member& member) { return *multibodies_[member.body]; }

  const description::World& description_;
  WorkerPool& workers_;
  double step_;
  SurfacePairs surfaces_;
  geometry::Scene scene_;
  std::vector<std::unique_ptr<Mechanism>> mechanisms_;                   // by model, null for what is static
  std::vector<std::vector<std::shared_ptr<const BulletShape>>> shapes_;  // by model, of its collisions in their order
  std::vector<std::unique_ptr<Multibody>> multibodies_;                  // by body, null for what is static
  std::vector<Member> members_;
  std::vector<std::uint32_t> member_of_body_;
  Anchors anchors_;
  std::vector<std::shared_ptr<const BulletShape>> shape_of_solid_;
  std::unique_ptr<Collision> collision_;
  Islands islands_;
  std::vector<Contact> contacts_;
  std::vector<Memory> memory_;  // by worker
  std::vector<char> finite_;    // by member
};

}  // namespace cohort::physics
