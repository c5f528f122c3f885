// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "server/geometry/visibility/outlines.hpp"

namespace cohort::geometry {

/// Decides from which places one source is visible: a lamp, or a robot that sends. Built for each source at each tick,
/// then queried for any number of receivers.
///
/// The directions around the source, seen from above, are cut into bins. Each bin has the solids that reach into it,
/// near ones first, each with the slopes at which a line may hit it. A query tests only solids between the two ends
/// that are neither above nor below the line, and the outlines decide most of these tests. The others are tested
/// exactly, as in Scene::cast_ray, so that the results are the same.
class SightLines {
 public:
  /// Builds the sight lines of a source, replacing the earlier content. `p_WS`: the source [m]. Nothing is seen beyond
  /// `range` [m], which may be infinite. The source is a part of `source_body`, which never blocks a line. `outlines`
  /// and its scene must outlive all queries. Threads may build different objects.
  void build(const Outlines& outlines, const Eigen::Vector3d& p_WS, double range, BodyId source_body = Scene::no_body) {
    build(outlines, p_WS, range, source_body, {});
  }
  /// The range of heights of all receivers. Solids that are above or below every line to it are left out.
  struct Heights {
    double lowest = -std::numeric_limits<double>::infinity();  ///< z_W [m]
    double highest = std::numeric_limits<double>::infinity();
  };
  void build(const Outlines& outlines, const Eigen::Vector3d& p_WS, double range, BodyId source_body,
             const Heights& receivers);

  /// Returns whether no solid is on the segment from the source to p_WR, both ends included, and the segment is not
  /// longer than the range. `receiver_body` never blocks the line either. Returns true if both ends are the same point.
  ///
  /// The result is exactly whether there is no hit of Scene::cast_ray from p_WS along (p_WR - p_WS) / d with range d =
  /// |p_WR - p_WS| among the solids of other bodies. Const, callable from any thread; p_WR must be finite.
  bool is_free(const Eigen::Vector3d& p_WR, BodyId receiver_body = Scene::no_body) const;

 private:
  /// A solid as seen from the source: all lengths are relative to the source. Outer bounds are slightly too large and
  /// inner ones slightly too small, against rounding.
  struct Candidate {
    double nearest = 0.0;  // least horizontal distance of its points [m]
    double farthest = 0.0;
    Eigen::Vector2d centre;
    double radius = 0.0;
    double lowest = 0.0;
    double highest = 0.0;
    double inner_radius = -1.0;
    double inner_lowest = 0.0;
    double inner_highest = 0.0;
    std::uint32_t solid = 0;
    BodyId body;
    std::uint32_t rectangle = Outlines::none;  // index in rectangles_, if its outline is one
  };
  struct Rectangle {
    Eigen::Vector2d axis;
    Eigen::Vector2d half;
    Eigen::Vector2d source;  // in the rectangle's frame
  };
  /// A plane, whose `normal_W` points out of the solid.
  struct HalfSpace {
    Eigen::Vector3d normal_W;
    double height = 0.0;    // height of the source above it
    double rounding = 0.0;  // bound on the rounding of heights
    std::uint32_t solid = 0;
    BodyId body;
  };
  /// A candidate in a bin, with the values that exclude it, rounded outward.
  struct Entry {
    float nearest = 0.0F;      // the candidate's
    float least_slope = 0.0F;  // slopes of lines that may hit it [m/m]
    float most_slope = 0.0F;
    std::uint32_t candidate = 0;
  };
  /// The bins that a candidate overlaps; `last` may exceed the number of bins and then wraps around.
  struct Stretch {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::uint32_t rank = 0;  // by distance
  };
  struct Line;

  void add(const Outlines::Item& item);
  void sort_candidates();
  static Entry entry_of(const Candidate& candidate);
  void fill_bins();
  bool is_blocked_by(const Candidate& candidate, const Line& line) const;
  bool is_hit(std::uint32_t solid, const Line& line) const;
  bool is_within_range(const Eigen::Vector3d& offset_W, double squared) const;

  const Scene* scene_ = nullptr;
  Eigen::Vector3d p_WS_ = Eigen::Vector3d::Zero();
  double range_ = 0.0;
  double bins_a_turn_ = 1.0;  // bins for each unit of turn_of
  std::uint32_t bins_ = 4;
  std::vector<HalfSpace> planes_;
  struct Unbounded {
    std::uint32_t solid;
    BodyId body;
  };
  std::vector<Unbounded> unbounded_;   // solids without an outline
  std::vector<Candidate> around_;      // those around, above or below the source
  std::vector<Candidate> candidates_;  // the others
  std::vector<Rectangle> rectangles_;
  std::vector<std::uint32_t> begin_;  // start of each bin in entries_, and one past the last
  std::vector<Entry> entries_;
  // Used only while building:
  std::vector<Stretch> stretches_;
  std::vector<std::uint32_t> order_;  // indices of candidates_, near ones first
};

}  // namespace cohort::geometry
