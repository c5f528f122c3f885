// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "server/geometry/scene/scene.hpp"
#include "server/physics/contact/bullet_contact.hpp"

namespace cohort::physics {

/// Two solids that are near each other; `a` moves. If both move, `a` is the one that is awake. If both are awake, `a`
/// is the fast one; if both or neither is fast, the one with the lower index.
struct SolidPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  ContactPoints contact;
  std::optional<BulletContact> general;  ///< if there is no closed form
};

/// Finds where the solids of a scene touch. Pairs are ordered by `a`, then by `b`, so that nothing depends on the
/// number of workers or on earlier pairs.
class Collision {
 public:
  /// Returns whether two solids of one body may collide.
  using MayTouch = std::function<bool(std::uint32_t, std::uint32_t)>;

  /// The scene must outlive this.
  Collision(const geometry::Scene& scene, MayTouch may_touch);

  /// Adds the next solid of the scene, with Bullet's shape of it. Solids are added in the order of the scene.
  void add(std::shared_ptr<const BulletShape> shape, bool moves);
  /// Reserves memory for this many solids.
  void reserve(std::size_t solids);
  /// Forgets a solid that is no longer in the scene.
  void remove(std::uint32_t solid);

  /// Returns the distance per step beyond which a solid could pass through another one undetected [m]. A solid that
  /// moves further is called fast.
  double furthest_unseen(std::uint32_t solid) const {
    constexpr double nearly = 0.9;
    return nearly * shapes_[solid]->half_thickness();
  }
  /// Returns the greatest distance over which a solid's motion is checked in one step [m].
  double furthest_followed(std::uint32_t solid) const { return most_places * furthest_unseen(solid); }
  /// Sets the displacement over the step [m] that a moving, fast solid would make if nothing stopped it, or zero for
  /// one that is not fast. Call it before `detect`; threads may call it for different solids.
  void set_way(std::uint32_t solid, const Eigen::Vector3d& way_W) { moving_[place_[solid]].way_W = way_W; }
  /// Sets whether a solid sleeps. A sleeping solid keeps its pairs unchanged and reports none with awake solids. Must
  /// not be called while another thread is in `detect`.
  void set_asleep(std::uint32_t solid, bool asleep) { moving_[place_[solid]].is_asleep = asleep; }
  /// Returns the bounds of all positions of the solid in the step, extended by `margin`.
  geometry::Bounds region_of(std::uint32_t solid) const { return region_along(solid, way_of(solid)); }

  /// Finds the pairs that `solid`, which moves, reports, and their contact points. The points are those for the present
  /// poses or, for a fast solid, for the poses where the two will meet. `near`: all solids that overlap its region, and
  /// possibly more, in ascending order. For a fast solid `near` also holds those whose own regions overlap it. Points
  /// that existed before keep their impulses. Threads may call it for different solids.
  void detect(std::uint32_t solid, std::span<const std::uint32_t> near);
  /// Points nearer than this are passed to the solver, which lets the bodies close the gap within the step [m].
  static constexpr double margin = 0.005;
  /// Returns the fraction of the displacement `way_W` that a solid can make up to the first static obstacle, for a
  /// solid that the solver has made faster than predicted. The solid must still be at its old pose. Threads may call it
  /// for different solids.
  double free_share(std::uint32_t solid, const Eigen::Vector3d& way_W) const;

  /// Saves all points, and the state on which the next points depend.
  void save(SnapshotWriter& writer) const;
  /// Restores what `save` wrote; the solids must have the poses at which they were saved.
  void restore(SnapshotReader& reader);

  /// Returns the pairs that a moving solid reports.
  std::span<SolidPair> pairs_of(std::uint32_t solid) { return moving_[place_[solid]].pairs; }
  std::span<const SolidPair> pairs_of(std::uint32_t solid) const { return moving_[place_[solid]].pairs; }

 private:
  static constexpr double most_places = 64.0;  // most sampled positions of one fast solid
  static constexpr std::uint32_t nowhere = 0xffffffffu;
  struct Moving {                    // additional data of a moving solid
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
  /// The point on its way at which a solid first touches another one.
  struct Touch {
    double share = 1.0;  // fraction of the way
    ContactPoints points;
  };
  Touch first_touch(std::uint32_t solid, std::uint32_t other, const Eigen::Vector3d& way_W) const;
  ContactPoints contact_at(const Pose& X_WA, std::uint32_t solid, std::uint32_t other) const;
  void add_points_beside(const Pose& X_WA, std::uint32_t solid, std::uint32_t other, ContactPoints& found) const;

  const geometry::Scene& scene_;
  std::vector<std::shared_ptr<const BulletShape>> shapes_;
  MayTouch may_touch_;
  std::vector<std::uint32_t> place_;  // by solid, index in moving_; `nowhere`: does not move
  std::vector<Moving> moving_;
};

}  // namespace cohort::physics
