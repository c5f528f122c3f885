#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "server/geometry/visibility/outlines.hpp"

namespace cohort::geometry {

/// Which places see one source: a lamp, or a robot that sends. Made for each source at each tick, then asked for any
/// number of receivers.
///
/// The directions around the source, seen from above, are cut into bins. Each bin has the solids that reach into it,
/// near ones first, each with the slopes at which a line may meet it. So a question goes through those between the two
/// ends that are neither above nor below the line, and most of these are decided by their outline. The others are asked
/// themselves, as Scene::cast_ray asks them; so the answers are the same.
class SightLines {
 public:
  /// Takes the place of what was built before. `p_WS`: the source [m]. Beyond `range` [m], which may be infinite,
  /// nothing is seen. The source is a part of `source_body`, which never stands in the way. `outlines` and its scene
  /// must outlive the questions. Different objects may be built from different threads.
  void build(const Outlines& outlines, const Eigen::Vector3d& p_WS, double range, BodyId source_body = Scene::no_body) {
    build(outlines, p_WS, range, source_body, {});
  }
  /// The same, for receivers that are all within these heights: what is above or below every line is left out.
  struct Heights {
    double lowest = -std::numeric_limits<double>::infinity();  ///< z_W [m]
    double highest = std::numeric_limits<double>::infinity();
  };
  void build(const Outlines& outlines, const Eigen::Vector3d& p_WS, double range, BodyId source_body,
             const Heights& receivers);

  /// Whether nothing solid is on the segment from the source to p_WR, both ends included, and this is no longer than
  /// the range. `receiver_body` never stands in the way either. True if both ends are the same point.
  ///
  /// The same, bit for bit, as no hit of Scene::cast_ray from p_WS along (p_WR - p_WS) / d with range d = |p_WR - p_WS|
  /// among the solids of other bodies. Const, callable from any thread; p_WR must be finite.
  bool is_free(const Eigen::Vector3d& p_WR, BodyId receiver_body = Scene::no_body) const;

 private:
  /// A solid as seen from the source: all lengths are relative to it. Outer bounds are a little too large and inner
  /// ones a little too small, against rounding.
  struct Candidate {
    double nearest = 0.0;  // no point of it is nearer along x and y [m]
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
    std::uint32_t rectangle = Outlines::none;  // in rectangles_, if it is one
  };
  struct Rectangle {
    Eigen::Vector2d axis;
    Eigen::Vector2d half;
    Eigen::Vector2d source;  // in the rectangle's frame
  };
  /// A plane, whose `normal_W` points out of what is solid.
  struct HalfSpace {
    Eigen::Vector3d normal_W;
    double height = 0.0;    // of the source above it
    double rounding = 0.0;  // of heights
    std::uint32_t solid = 0;
    BodyId body;
  };
  /// A candidate in a bin, with what leaves it out: rounded outward.
  struct Entry {
    float nearest = 0.0F;      // as of the candidate
    float least_slope = 0.0F;  // of lines that may meet it: metres up for each metre along
    float most_slope = 0.0F;
    std::uint32_t candidate = 0;
  };
  /// Bins that a candidate reaches into; `last` may be beyond the number of bins and go on from the first.
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
  std::vector<Unbounded> unbounded_;   // that no outline holds
  std::vector<Candidate> around_;      // those that the source is in or below or above
  std::vector<Candidate> candidates_;  // the others
  std::vector<Rectangle> rectangles_;
  std::vector<std::uint32_t> begin_;  // of each bin in entries_, and one past the last
  std::vector<Entry> entries_;
  // While it is built:
  std::vector<Stretch> stretches_;
  std::vector<std::uint32_t> order_;  // of candidates_, near ones first
};

}  // namespace cohort::geometry
