#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "server/geometry/scene/scene.hpp"
#include "server/physics/contact/bullet_contact.hpp"

namespace cohort::physics {

/// Two solids that are near each other. `a` moves; if both do, it is the one that is awake, or fast or, if both are or
/// neither is, has the lower index.
struct SolidPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  ContactPoints contact;
  std::optional<BulletContact> general;  ///< where there is no closed form
};

/// Finds where the solids of a scene touch. Pairs are in the order of `a`, then of `b`, so nothing depends on the
/// number of workers or on what was near before.
class Collision {
 public:
  /// Says whether two solids of one body may touch each other.
  using MayTouch = std::function<bool(std::uint32_t, std::uint32_t)>;

  /// The scene must outlive this.
  Collision(const geometry::Scene& scene, MayTouch may_touch);

  /// Solids in the order of the scene, each with Bullet's shape of it.
  void add(std::shared_ptr<const BulletShape> shape, bool moves);
  /// Takes memory for as many solids.
  void reserve(std::size_t solids);
  /// Forgets a solid that is no longer in the scene.
  void remove(std::uint32_t solid);

  /// Further than this in one step a solid could pass through another one without ever touching it [m]: it is fast.
  double furthest_unseen(std::uint32_t solid) const {
    constexpr double nearly = 0.9;
    return nearly * shapes_[solid]->half_thickness();
  }
  /// Further than this nothing is followed in one step [m].
  double furthest_followed(std::uint32_t solid) const { return most_places * furthest_unseen(solid); }
  /// Where a solid that moves and is fast will be at the end of the step if nothing holds it, less where it is [m];
  /// zero for one that is not. Different solids from different threads, before `detect`.
  void set_way(std::uint32_t solid, const Eigen::Vector3d& way_W) { moving_[place_[solid]].way_W = way_W; }
  /// What sleeps leaves its pairs as they are, and reports none with what is awake. Not while others `detect`.
  void set_asleep(std::uint32_t solid, bool asleep) { moving_[place_[solid]].is_asleep = asleep; }
  /// All places of the solid in the step, and `margin` around them.
  geometry::Bounds region_of(std::uint32_t solid) const { return region_along(solid, way_of(solid)); }

  /// Finds the pairs that `solid`, which moves, reports, and their contact points for the present poses or, of what is
  /// fast, for those where the two will meet. `near`: in ascending order all solids, and maybe more, that its region
  /// overlaps, and if it is fast those too whose own regions do. Points that were there before keep their impulses.
  /// Different solids from different threads.
  void detect(std::uint32_t solid, std::span<const std::uint32_t> near);
  /// Points this near count as touching for the solver, which lets them close the gap within the step [m].
  static constexpr double margin = 0.005;
  /// Which share of its way a solid that still is where it was may go, though the solver has made it faster than it was
  /// foreseen: up to what stands still in its way. Different solids from different threads.
  double free_share(std::uint32_t solid, const Eigen::Vector3d& way_W) const;

  /// All points and what decides the next ones.
  void save(SnapshotWriter& writer) const;
  /// With the solids where they were when it was saved.
  void restore(SnapshotReader& reader);

  /// The pairs that solid `a`, which moves, reports.
  std::span<SolidPair> pairs_of(std::uint32_t solid) { return moving_[place_[solid]].pairs; }
  std::span<const SolidPair> pairs_of(std::uint32_t solid) const { return moving_[place_[solid]].pairs; }

 private:
  static constexpr double most_places = 64.0;  // where one fast solid is looked for on its way
  static constexpr std::uint32_t nowhere = 0xffffffffu;
  struct Moving {                    // what a solid that moves has more than others
    std::vector<SolidPair> pairs{};  // ascending b
    Eigen::Vector3d way_W = Eigen::Vector3d::Zero();
    bool is_asleep = false;
  };

  bool moves(std::uint32_t solid) const { return place_[solid] != nowhere; }
  Eigen::Vector3d way_of(std::uint32_t solid) const {
    return moves(solid) ? moving_[place_[solid]].way_W : Eigen::Vector3d::Zero();
  }
  bool is_asleep(std::uint32_t solid) const { return moving_[place_[solid]].is_asleep; }
  bool is_fast(std::uint32_t solid) const { return !way_of(solid).isZero(0.0); }
  geometry::Bounds region_along(std::uint32_t solid, const Eigen::Vector3d& way_W) const;
  bool reports(std::uint32_t solid, std::uint32_t other) const;
  bool makes_a_pair(std::uint32_t solid, std::uint32_t other) const;
  void find_pairs(std::uint32_t solid, std::span<const std::uint32_t> near);
  void find_contact(SolidPair& pair);
  void find_contact_on_the_way(SolidPair& pair);
  /// Where on its way a solid first touches another one.
  struct Touch {
    double share = 1.0;  // of the way
    ContactPoints points;
  };
  Touch first_touch(std::uint32_t solid, std::uint32_t other, const Eigen::Vector3d& way_W) const;
  ContactPoints contact_at(const Pose& X_WA, std::uint32_t solid, std::uint32_t other) const;
  void add_points_beside(const Pose& X_WA, std::uint32_t solid, std::uint32_t other, ContactPoints& found) const;

  const geometry::Scene& scene_;
  std::vector<std::shared_ptr<const BulletShape>> shapes_;
  MayTouch may_touch_;
  std::vector<std::uint32_t> place_;  // by solid, in moving_; `nowhere`: it does not move
  std::vector<Moving> moving_;
};

}  // namespace cohort::physics
