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

/// Two solids that touch, or are about to. `a` is of the member that reports them.
struct PlanarPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t member_b = Anchors::nobody;  ///< `nobody`: b does not move
  double z = 0.0;                            ///< in the middle of the heights that they share [m]
  PlanarPoints contact;
};

/// Finds where the outlines of bodies touch each other and the walls. Pairs are in the order of `a`, then of `b`, so
/// nothing depends on the number of workers or on what was near before.
class PlanarCollision {
 public:
  /// The scene must outlive this.
  explicit PlanarCollision(const geometry::Scene& scene) : scene_(scene) {}

  void reserve(std::size_t solids) {
    outlines_.reserve(solids);
    member_of_solid_.reserve(solids);
  }
  /// Throws std::invalid_argument for a solid that does not move and is neither flat ground nor an upright wall.
  static void check_static(const description::Shape& shape, const Pose& X_WC);
  /// Adds the next solid of the scene, one that does not move: a wall, or what nothing can run into. Throws as
  /// `check_static`.
  void add_static();
  /// The next body that moves, or, `is_fixed`, whose segments do at the most. Its solids follow.
  void add_member(bool is_fixed);
  /// The next solid of the scene, one of the last member.
  void add_moving();
  /// After a solid that does not move was put elsewhere. Throws as `add_static`.
  void place_static(std::uint32_t solid) { outlines_[solid] = outline_of_static(solid); }
  /// Forgets a member that is no longer in the scene.
  void remove(std::uint32_t member);
  /// Takes it in again.
  void put_back(std::uint32_t member) { members_[member].is_active = true; }
  /// Forgets what a member touches.
  void forget(std::uint32_t member);

  /// Where a solid that moves is now; different ones from any thread.
  void move(std::uint32_t solid, const Eigen::Vector2d& centre_W, const Eigen::Vector2d& axis_W) {
    auto& outline = std::get<geometry::Footprint>(outlines_[solid]);
    outline.centre = centre_W;
    outline.axis = axis_W;
  }
  /// As `move`, with its shape and heights too.
  void set_outline(std::uint32_t solid, const geometry::Footprint& outline_W) { outlines_[solid] = outline_W; }
  /// Where a member is now; its solids lie within `radius` of there and between two heights.
  void move_member(std::uint32_t member, const Eigen::Vector2d& centre_W) { places_[member].centre_W = centre_W; }
  void set_extent(std::uint32_t member, double radius, double lowest, double highest) {
    places_[member] = {places_[member].centre_W, radius, lowest, highest};
  }

  /// Points that were there before keep their impulses.
  void detect(WorkerPool& workers);

  /// The pairs that a member reports: with solids that do not move, and of members above it.
  std::span<PlanarPair> pairs_of(std::uint32_t member) { return members_[member].pairs; }
  std::span<const PlanarPair> pairs_of(std::uint32_t member) const { return members_[member].pairs; }

  /// All points.
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
  struct Memory {  // of one chunk
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
  PlanarGrid grid_;             // of the active members that have solids
  std::vector<Memory> memory_;  // by worker
};

}  // namespace cohort::physics
