// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "server/core/snapshot.hpp"
#include "server/core/worker_pool.hpp"
#include "server/geometry/scene/scene.hpp"
#include "server/physics/planar/planar_contact.hpp"
#include "server/physics/planar/planar_grid.hpp"
#include "server/physics/world/anchors.hpp"

namespace cohort::physics {

/// Two solids that touch or are about to. `a` belongs to the member that reports them.
struct PlanarPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t member_b = Anchors::nobody;  ///< `nobody`: b is static
  double z = 0.0;                            ///< middle of the common height range [m]
  PlanarPoints contact;
};

/// Finds where the outlines of bodies touch each other and walls. Pairs are ordered by `a`, then by `b`, so that
/// nothing depends on the number of workers or on earlier pairs.
class PlanarCollision {
 public:
  /// The scene must outlive this.
  explicit PlanarCollision(const geometry::Scene& scene) : scene_(scene) {}

  void reserve(std::size_t solids) {
    outlines_.reserve(solids);
    member_of_solid_.reserve(solids);
  }
  /// Throws std::invalid_argument for a static solid that is neither flat ground nor an upright wall.
  static void check_static(const description::Shape& shape, const Pose& X_WC);
  /// Adds the next solid of the scene, a static one: a wall, or one that no body can hit. Throws like `check_static`.
  void add_static();
  /// Adds the next moving body; its solids follow. `is_fixed`: its root is fixed to the world, and at most its segments
  /// move.
  void add_member(bool is_fixed);
  /// Adds the next solid of the scene to the last member.
  void add_moving();
  /// Updates a static solid that was placed elsewhere. Throws like `add_static`.
  void place_static(std::uint32_t solid) { outlines_[solid] = outline_of_static(solid); }
  /// Forgets a member that is no longer in the scene.
  void remove(std::uint32_t member);
  /// Adds a removed member again.
  void put_back(std::uint32_t member) { members_[member].is_active = true; }
  /// Forgets the contacts of a member.
  void forget(std::uint32_t member);

  /// Moves a solid of a moving body; threads may call it for different solids.
  void move(std::uint32_t solid, const Eigen::Vector2d& centre_W, const Eigen::Vector2d& axis_W) {
    auto& outline = std::get<geometry::Footprint>(outlines_[solid]);
    outline.centre = centre_W;
    outline.axis = axis_W;
  }
  /// Sets the outline of a solid: its pose, shape and heights; threads may call it like `move`.
  void set_outline(std::uint32_t solid, const geometry::Footprint& outline_W) { outlines_[solid] = outline_W; }
  /// Moves the centre of the circle that bounds a member's solids.
  void move_member(std::uint32_t member, const Eigen::Vector2d& centre_W) { places_[member].centre_W = centre_W; }
  /// Sets the radius of that circle, and the least and greatest z of the member's solids [m].
  void set_extent(std::uint32_t member, double radius, double lowest, double highest) {
    places_[member] = {places_[member].centre_W, radius, lowest, highest};
  }

  /// Finds all pairs and points. Points that existed before keep their impulses.
  void detect(WorkerPool& workers);

  /// Returns the pairs that a member reports: with static solids, and with members of a higher index.
  std::span<PlanarPair> pairs_of(std::uint32_t member) { return members_[member].pairs; }
  std::span<const PlanarPair> pairs_of(std::uint32_t member) const { return members_[member].pairs; }

  /// Saves and restores all points.
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  using Outline = std::variant<std::monostate, geometry::Footprint, HalfPlane>;
  struct Member {
    std::uint32_t first_solid = 0;
    std::uint32_t solid_count = 0;
    bool is_fixed = false;
    bool is_active = true;
    std::vector<PlanarPair> pairs{};
  };
  struct Place {
    Eigen::Vector2d centre_W = Eigen::Vector2d::Zero();
    double radius = 0.0;
    double lowest = 0.0;
    double highest = 0.0;
  };
  struct Memory {  // scratch memory of one chunk
    std::vector<std::uint32_t> near;
    std::vector<PlanarPair> pairs;
  };
  Outline outline_of_static(std::uint32_t index) const;
  static Outline outline_of(const description::Shape& shape, const Pose& X_WC);
  void find_near(std::uint32_t index, std::vector<std::uint32_t>& near) const;
  void find_pairs(std::uint32_t index, Memory& memory);
  void find_contact(std::uint32_t solid, std::uint32_t other, Memory& memory);

  const geometry::Scene& scene_;
  std::vector<Outline> outlines_;               // by solid
  std::vector<std::uint32_t> member_of_solid_;  // `nobody`: does not move
  std::vector<Member> members_;
  std::vector<Place> places_;  // by member
  std::vector<PlanarGrid::Disc> discs_;
  PlanarGrid grid_;             // holds the active members that have solids
  std::vector<Memory> memory_;  // by worker
};

}  // namespace cohort::physics
