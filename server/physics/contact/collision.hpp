#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "server/geometry/scene/scene.hpp"
#include "server/physics/contact/bullet_contact.hpp"

namespace cohort::physics {

/// Two solids that are near each other. `a` moves; if both do, it has the lower index.
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

  /// Finds the pairs that `solid`, which moves, reports, and their contact points for the present poses. `near`: in
  /// ascending order all solids, and maybe more, whose bounds overlap its own grown by `margin`. Points that were there
  /// before keep their impulses. Different solids from different threads.
  void detect(std::uint32_t solid, std::span<const std::uint32_t> near);
  /// Points this near count as touching for the solver, which lets them close the gap within the step [m].
  static constexpr double margin = 0.005;

  /// All points and what decides the next ones.
  void save(SnapshotWriter& writer) const;
  /// With the solids where they were when it was saved.
  void restore(SnapshotReader& reader);

  /// The pairs that solid `a` reports.
  std::span<SolidPair> pairs_of(std::uint32_t solid) { return pairs_[solid]; }
  std::span<const SolidPair> pairs_of(std::uint32_t solid) const { return pairs_[solid]; }

 private:
  bool makes_a_pair(std::uint32_t solid, std::uint32_t other) const;
  void find_pairs(std::uint32_t solid, std::span<const std::uint32_t> near);
  void find_contact(SolidPair& pair);

  const geometry::Scene& scene_;
  std::vector<std::shared_ptr<const BulletShape>> shapes_;
  MayTouch may_touch_;
  BulletNarrowPhase narrow_phase_;
  std::vector<std::vector<SolidPair>> pairs_;  // by solid, ascending b
};

}  // namespace cohort::physics
