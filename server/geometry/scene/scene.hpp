// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/core/ids.hpp"
#include "server/geometry/scene/corner_grid.hpp"
#include "server/geometry/scene/grid.hpp"
#include "server/geometry/scene/solid.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::geometry {

/// A solid that belongs to no model.
struct LoneSolid {
  Shape shape;
  description::Surface surface;
  BodyId body;
  bool moves = false;
  Pose X_WC;
};

struct RayHit {
  double distance = 0.0;  ///< [m], 0 if the ray starts inside the solid
  std::uint32_t solid = 0;
  Eigen::Vector3d normal_W;  ///< outward; zero if the ray starts inside
};

/// All solids of the world, for collision, ground contact, sensing and placement. Poses are set between `update` calls;
/// queries are const and may run from any thread.
class Scene {
 public:
  static constexpr BodyId no_body{0xffffffffu};

  /// Adds a solid; `build` must follow before the first query. Returns its index.
  std::uint32_t add(SolidKindPtr kind, BodyId body, bool moves, const Pose& X_WC);
  std::uint32_t add(const LoneSolid& solid);
  /// Reserves memory for exactly this many solids.
  void reserve(std::size_t solids);
  /// Chooses the cell size and sorts the static solids. Call it after the last `add`, and again after later ones.
  void build();
  /// Excludes a solid from all further queries until `put_back`. Its index is not reused until `renew`.
  void remove(std::uint32_t index);
  void put_back(std::uint32_t index);
  /// Puts a removed solid back as a solid of another body of the same model; `build` must follow before the next query.
  void renew(std::uint32_t index, BodyId body, const Pose& X_WC);
  bool is_removed(std::uint32_t index) const { return is_removed_[index] != 0; }

  std::size_t size() const { return solids_.size(); }
  const Solid& solid(std::uint32_t index) const { return solids_[index]; }
  const Bounds& bounds(std::uint32_t index) const { return bounds_[index]; }

  /// Moves a solid. Threads may move different moving solids; a static one requires `build` afterwards.
  void set_pose(std::uint32_t index, const Pose& X_WC);
  /// Updates the grid with the new poses.
  void update();

  /// Returns the first solid along a ray of unit direction and length `range`, which may be infinite. Solids of
  /// `ignored_body` are ignored. If two solids are at exactly the same distance, the one with the lower index is hit,
  /// so that the result depends only on the scene.
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range,
                                 BodyId ignored_body = no_body) const;

  /// Returns whether such a ray hits nothing except these two bodies.
  bool is_free(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range, BodyId ignored_body,
               BodyId other_ignored_body = no_body) const;

  /// Casts a ray like `cast_ray`, among `candidates` only.
  std::optional<RayHit> cast_ray_among(std::span<const std::uint32_t> candidates, const Eigen::Vector3d& origin_W,
                                       const Eigen::Vector3d& direction_W, double range) const;

  /// The bounding sphere of a solid, around its origin: a ray that misses the sphere misses the solid.
  struct Ball {
    Eigen::Vector3d centre_W;
    double radius = 0.0;  ///< [m], infinite for planes and height maps

    /// Returns whether a ray certainly misses it within the distance `reach`.
    bool is_missed(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double reach) const {
      const Eigen::Vector3d offset = centre_W - origin_W;
      const double along = offset.dot(direction_W);
      return along < -radius || along > reach + radius || offset.squaredNorm() - along * along > radius * radius;
    }
  };
  Ball ball(std::uint32_t index) const { return {solids_[index].X_WC.position, solids_[index].radius}; }

  /// Sets `best` to the hit of this solid if it is nearer along the ray, or equally near with a lower index. Returns
  /// the distance beyond which no other hit is nearer [m].
  double improve(std::optional<RayHit>& best, std::uint32_t index, const Eigen::Vector3d& origin_W,
                 const Eigen::Vector3d& direction_W, double range) const;

  /// Returns whether a solid's bounds overlap `query`; for a plane, whether its solid side does.
  bool reaches_into(std::uint32_t index, const Bounds& query) const {
    return std::holds_alternative<description::Plane>(solids_[index].shape()) ? reaches(index, query)
                                                                              : bounds_[index].overlaps(query);
  }

  /// Calls `visit(index)` once for each solid whose bounds (for a plane, its solid side) overlap `query`.
  template <class Visit>
  void for_each_overlap(const Bounds& query, Visit&& visit) const {
    for_each_static_overlap(query, visit);
    moving_grid_.for_each_overlap(query, visit);
    for (const std::uint32_t index : large_moving_)
      if (bounds_[index].overlaps(query)) visit(index);
    wide_grid_.for_each_overlap(query, bounds_, visit);
  }
  /// Does the same for static solids only.
  template <class Visit>
  void for_each_static_overlap(const Bounds& query, Visit&& visit) const {
    for (const std::uint32_t index : large_)
      if (reaches(index, query)) visit(index);
    static_grid_.for_each_overlap(query, bounds_, visit);
  }

 private:
  double choose_cell_size() const;
  bool reaches(std::uint32_t large_solid, const Bounds& query) const;
  std::vector<Solid> solids_;
  std::vector<Eigen::Vector3d> p_CW_;  // by solid: the world's origin in its frame
  std::vector<Bounds> bounds_;
  std::vector<char> is_removed_;
  // Static solids:
  std::vector<std::uint32_t> large_;  // planes, and solids that would fill many cells
  Grid static_grid_;
  // Moving solids:
  std::vector<std::uint32_t> moving_;        // no wider than a cell, in any orientation
  std::vector<std::uint32_t> wide_;          // wider, but in few cells
  std::vector<std::uint32_t> large_moving_;  // would fill many cells
  CornerGrid moving_grid_;
  Grid wide_grid_;
};

}  // namespace cohort::geometry
