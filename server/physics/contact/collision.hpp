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
  void add(std::shared_ptr<const BulletShape> shape);
  /// Forgets a solid that is no longer in the scene.
  void remove(std::uint32_t solid);

  /// Further than this in one step a solid could pass through another one without ever touching it [m]: it is fast.
  double furthest_unseen(std::uint32_t solid) const { return furthest_unseen_[solid]; }
  /// Further than this nothing is followed in one step [m].
  double furthest_followed(std::uint32_t solid) const { return most_places * furthest_unseen_[solid]; }
  /// Where a solid that is fast will be at the end of the step if nothing holds it, less where it is [m]; zero for one
  /// that is not. Different solids from different threads, before `detect`.
  void set_way(std::uint32_t solid, const Eigen::Vector3d& way_W) { ways_[solid] = way_W; }
  /// What sleeps leaves its pairs as they are, and reports none with what is awake. Not while others `detect`.
  void set_asleep(std::uint32_t solid, bool asleep) { is_asleep_[solid] = asleep ? 1 : 0; }
  /// All places of the solid in the step, and `margin` around them.
  geometry::Bounds region_of(std::uint32_t solid) const { return region_along(solid, ways_[solid]); }

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

  /// The pairs that solid `a` reports.
  std::span<SolidPair> pairs_of(std::uint32_t solid) { return pairs_[solid]; }
  std::span<const SolidPair> pairs_of(std::uint32_t solid) const { return pairs_[solid]; }

 private:
  static constexpr double most_places = 64.0;  // where one fast solid is looked for on its way

  bool is_fast(std::uint32_t solid) const { return !ways_[solid].isZero(0.0); }
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
  std::vector<std::vector<SolidPair>> pairs_;  // by solid, ascending b
  std::vector<double> furthest_unseen_;        // by solid
  std::vector<Eigen::Vector3d> ways_;          // by solid
  std::vector<std::uint8_t> is_asleep_;        // by solid
};

}  // namespace cohort::physics
