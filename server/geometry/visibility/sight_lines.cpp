// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/sight_lines.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "server/core/infinity.hpp"
#include "server/core/plane_vectors.hpp"
#include "server/geometry/visibility/rounding.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double turns = 4.0;            // units of turn_of in a full turn
constexpr double least_square = 1e-200;  // squares of lengths below this lose digits [m^2]
constexpr std::uint32_t least_bins = 16;
constexpr std::uint32_t most_bins = 256;
constexpr std::size_t ranks = 256;  // number of ranks by which distances are sorted

// Returns a value that grows with the azimuth, from 0 along x to 4 at the full turn: the length along a square that
// stands on its corner. It needs neither a root nor an arc tangent.
double turn_of(const Vector2d& direction) {
  const double across = direction.y() / (std::abs(direction.x()) + std::abs(direction.y()));
  if (direction.x() < 0.0) return 2.0 - across;
  return across < 0.0 ? turns + across : across;
}

bool both_above(double a, double b, double limit) { return a > limit && b > limit; }
bool both_below(double a, double b, double limit) { return a < limit && b < limit; }

}  // namespace

/// The segment from the source to a receiver.
struct SightLines::Line {
  Vector3d offset_W;
  // Seen from above:
  double length;
  Vector2d along;  // unit, within rounding; NaN if the length is 0
  double slope;
  BodyId receiver_body;
};

void SightLines::build(const Outlines& outlines, const Vector3d& p_WS, double range, BodyId source_body,
                       const Heights& receivers) {
  scene_ = &outlines.scene();
  p_WS_ = p_WS;
  range_ = range;
  planes_.clear();
  unbounded_.clear();
  around_.clear();
  rectangles_.clear();
  candidates_.clear();
  stretches_.clear();
  const double lowest = std::min(p_WS.z(), receivers.lowest);
  const double highest = std::max(p_WS.z(), receivers.highest);
  const auto is_beside_all = [&](const Outline& outline) {
    return outline.highest + rounding_of(std::abs(outline.highest)) < lowest ||
           outline.lowest - rounding_of(std::abs(outline.lowest)) > highest;
  };
  outlines.for_each_near(p_WS, range, [&](const Outlines::Item& item) {
    if (item.body != source_body && !(item.outline && is_beside_all(*item.outline))) add(item);
  });
  sort_candidates();
  fill_bins();
}

void SightLines::add(const Outlines::Item& item) {
  if (!item.outline) {
    const Solid& solid = scene_->solid(item.solid);
    if (const auto* plane = std::get_if<description::Plane>(&solid.shape())) {
      const Vector3d normal_W = solid.X_WC.orientation * plane->normal;
      const Vector3d offset_W = p_WS_ - solid.X_WC.position;
      planes_.push_back({normal_W, normal_W.dot(offset_W), rounding_of(offset_W.norm()), item.solid, item.body});
    } else {
      unbounded_.push_back({item.solid, item.body});
    }
    return;
  }

  const Outline& outline = *item.outline;
  const Vector2d centre = outline.centre_W - p_WS_.head<2>();
  const double squared = centre.squaredNorm();
  const double most = range_ + outline.radius + rounding_of(range_ + outline.radius);
  if (squared > most * most) return;
  const double distance = std::sqrt(squared);
  const double rounding = rounding_of(distance + outline.radius);
  Candidate candidate;
  candidate.centre = centre;
  candidate.radius = outline.radius + rounding;
  candidate.lowest = outline.lowest - p_WS_.z() - rounding;
  candidate.highest = outline.highest - p_WS_.z() + rounding;
  if (const double inner = outline.inner_radius - rounding;
      inner > 0.0 && outline.inner_highest - outline.inner_lowest > 2.0 * rounding) {
    candidate.inner_radius = inner;
    candidate.inner_lowest = outline.inner_lowest - p_WS_.z() + rounding;
    candidate.inner_highest = outline.inner_highest - p_WS_.z() - rounding;
  }
  candidate.solid = item.solid;
  candidate.body = item.body;

  Vector2d rightmost, leftmost;  // it is seen between these directions
  if (outline.is_round()) {
    candidate.nearest = distance - candidate.radius;
    const double tangent = std::sqrt(std::max(0.0, squared - candidate.radius * candidate.radius));
    const Vector2d turned = candidate.radius * left_of(centre);
    rightmost = tangent * centre - turned;
    leftmost = tangent * centre + turned;
  } else {
    const Vector2d& axis = outline.axis_W;
    const Vector2d half = outline.half.array() + rounding;
    const Vector2d source(-axis.dot(centre), -cross(axis, centre));
    candidate.nearest = (source.cwiseAbs() - half).cwiseMax(0.0).norm();
    candidate.rectangle = static_cast<std::uint32_t>(rectangles_.size());
    rectangles_.push_back({axis, half, source});
    const Vector2d edge = half.x() * axis;
    const Vector2d side = half.y() * left_of(axis);
    rightmost = leftmost = centre - edge - side;
    for (const Vector2d& corner :
         {Vector2d(centre + edge - side), Vector2d(centre + edge + side), Vector2d(centre - edge + side)}) {
      if (cross(rightmost, corner) < 0.0) rightmost = corner;
      if (cross(leftmost, corner) > 0.0) leftmost = corner;
    }
  }
  candidate.farthest = distance + candidate.radius;
  if (candidate.nearest <= rounding) {
    around_.push_back(candidate);
    return;
  }
  constexpr double slack = 1e-12;  // more than the rounding of turn_of
  const double from = turn_of(rightmost);
  double to = turn_of(leftmost);
  if (to < from) to += turns;
  // In units of the finest bins; fill_bins makes the bins coarser.
  constexpr double fine = most_bins / turns;
  const double first = std::max(0.0, (from - slack) * fine);
  stretches_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>((to + slack) * fine), 0});
  candidates_.push_back(candidate);
}

// Sorts coarsely by counting: within a rank the order stays. `nearest` then becomes the minimum over its rank.
void SightLines::sort_candidates() {
  const std::size_t count = candidates_.size();
  double farthest = 0.0;
  for (const Candidate& candidate : candidates_) farthest = std::max(farthest, candidate.nearest);
  const double a_metre = farthest > 0.0 ? static_cast<double>(ranks - 1) / farthest : 0.0;
  std::array<std::uint32_t, ranks + 1> begin{};
  std::array<double, ranks> least;
  least.fill(infinity);
  for (std::size_t i = 0; i < count; ++i) {
    const auto rank = static_cast<std::uint32_t>(candidates_[i].nearest * a_metre);
    stretches_[i].rank = rank;
    ++begin[rank + 1];
    least[rank] = std::min(least[rank], candidates_[i].nearest);
  }
  for (std::size_t rank = 0; rank < ranks; ++rank) begin[rank + 1] += begin[rank];
  order_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    order_[begin[stretches_[i].rank]++] = static_cast<std::uint32_t>(i);
    candidates_[i].nearest = least[stretches_[i].rank];
  }
}

SightLines::Entry SightLines::entry_of(const Candidate& candidate) {
  constexpr float rounding = 1e-6F;  // some ulps of a float
  const double least = candidate.lowest / (candidate.lowest < 0.0 ? candidate.nearest : candidate.farthest);
  const double most = candidate.highest / (candidate.highest > 0.0 ? candidate.nearest : candidate.farthest);
  Entry entry;
  entry.nearest = static_cast<float>(candidate.nearest) * (1.0F - rounding);
  entry.least_slope = static_cast<float>(least);
  entry.least_slope -= rounding * std::abs(entry.least_slope);
  entry.most_slope = static_cast<float>(most);
  entry.most_slope += rounding * std::abs(entry.most_slope);
  return entry;
}

void SightLines::fill_bins() {
  const auto count = static_cast<std::uint32_t>(candidates_.size());
  bins_ = std::bit_ceil(std::clamp(count, least_bins, most_bins));
  bins_a_turn_ = static_cast<double>(bins_) / turns;
  const int coarser = std::countr_zero(most_bins / bins_);
  const auto for_each_bin = [&](const Stretch& stretch, auto&& act) {
    const std::uint32_t first = stretch.first >> coarser;
    const std::uint32_t last = std::min(stretch.last >> coarser, first + bins_ - 1);
    for (std::uint32_t bin = first; bin <= last; ++bin) act(bin & (bins_ - 1));
  };
  begin_.assign(bins_ + 2, 0);
  for (const Stretch& stretch : stretches_) for_each_bin(stretch, [&](std::uint32_t bin) { ++begin_[bin + 2]; });
  for (std::uint32_t bin = 0; bin < bins_; ++bin) begin_[bin + 2] += begin_[bin + 1];
  entries_.resize(begin_[bins_ + 1]);
  for (const std::uint32_t candidate : order_) {
    Entry entry = entry_of(candidates_[candidate]);
    entry.candidate = candidate;
    for_each_bin(stretches_[candidate], [&](std::uint32_t bin) { entries_[begin_[bin + 1]++] = entry; });
  }
}

bool SightLines::is_hit(std::uint32_t solid, const Line& line) const {
  const double distance = line.offset_W.norm();
  const Vector3d direction_W = line.offset_W / distance;
  if (scene_->ball(solid).is_missed(p_WS_, direction_W, distance)) return false;
  std::optional<RayHit> hit;
  scene_->improve(hit, solid, p_WS_, direction_W, distance);
  return hit.has_value();
}

inline bool SightLines::is_blocked_by(const Candidate& candidate, const Line& line) const {
  // Every test is written so that NaN decides nothing.
  const double middle = line.along.dot(candidate.centre);
  const double beside = cross(line.along, candidate.centre);
  const double squared = candidate.radius * candidate.radius - beside * beside;
  if (squared < 0.0 || candidate.body == line.receiver_body) return false;
  const double inner_squared = candidate.inner_radius * candidate.inner_radius - beside * beside;
  const bool meets_inner = candidate.inner_radius > 0.0 && inner_squared > 0.0;
  // The first test saves a root and finds most hits.
  const double at = std::clamp(middle, 0.0, line.length);
  const double at_z = line.slope * at;
  if (meets_inner && (at - middle) * (at - middle) < inner_squared && at_z > candidate.inner_lowest &&
      at_z < candidate.inner_highest)
    return true;
  const double half = std::sqrt(squared);
  const double entry = std::max(middle - half, 0.0);
  const double exit = std::min(middle + half, line.length);
  if (entry > exit) return false;
  if (both_above(line.slope * entry, line.slope * exit, candidate.highest) ||
      both_below(line.slope * entry, line.slope * exit, candidate.lowest))
    return false;
  if (meets_inner) {
    const double inner_half = std::sqrt(inner_squared);
    const double first = std::max(middle - inner_half, 0.0);
    const double last = std::min(middle + inner_half, line.length);
    const double first_z = line.slope * first;
    const double last_z = line.slope * last;
    if (first <= last && std::min(first_z, last_z) <= candidate.inner_highest &&
        std::max(first_z, last_z) >= candidate.inner_lowest)
      return true;
  }
  if (candidate.rectangle != Outlines::none) {
    const Rectangle& rectangle = rectangles_[candidate.rectangle];
    const Vector2d offset = line.offset_W.head<2>();
    const Vector2d receiver = rectangle.source + Vector2d(rectangle.axis.dot(offset), cross(rectangle.axis, offset));
    for (int i = 0; i < 2; ++i)
      if (both_above(rectangle.source[i], receiver[i], rectangle.half[i]) ||
          both_below(rectangle.source[i], receiver[i], -rectangle.half[i]))
        return false;
  }
  return is_hit(candidate.solid, line);
}

// The squares decide unless they are this close; then compare the lengths themselves.
bool SightLines::is_within_range(const Vector3d& offset_W, double squared) const {
  constexpr double rounding = 1e-12;
  const double limit = range_ * range_;
  if (squared < limit * (1.0 - rounding)) return true;
  return !(squared > limit * (1.0 + rounding)) && offset_W.norm() <= range_;
}

bool SightLines::is_free(const Vector3d& p_WR, BodyId receiver_body) const {
  Line line;
  line.offset_W = p_WR - p_WS_;
  const double level_squared = line.offset_W.head<2>().squaredNorm();
  const double squared = level_squared + line.offset_W.z() * line.offset_W.z();
  if (squared == 0.0) return true;
  if (!is_within_range(line.offset_W, squared)) return false;
  line.length = level_squared < least_square ? 0.0 : std::sqrt(level_squared);
  line.receiver_body = receiver_body;
  const double inverse = 1.0 / line.length;
  line.along = inverse * line.offset_W.head<2>();
  line.slope = inverse * line.offset_W.z();

  for (const HalfSpace& plane : planes_)
    if (!both_above(plane.height, plane.height + plane.normal_W.dot(line.offset_W), plane.rounding) &&
        plane.body != receiver_body && is_hit(plane.solid, line))
      return false;
  for (const Candidate& candidate : around_)
    if (is_blocked_by(candidate, line)) return false;
  for (const Unbounded& unbounded : unbounded_)
    if (unbounded.body != receiver_body && is_hit(unbounded.solid, line)) return false;
  if (line.length == 0.0) return true;  // vertical: only candidates of around_ can block it

  const auto bin = std::min(static_cast<std::uint32_t>(turn_of(line.offset_W.head<2>()) * bins_a_turn_), bins_ - 1);
  const auto slope = static_cast<float>(line.slope);
  const auto length = static_cast<float>(line.length);
  for (std::uint32_t i = begin_[bin]; i < begin_[bin + 1]; ++i) {
    const Entry& entry = entries_[i];
    if (entry.nearest > length) break;
    if (slope < entry.least_slope || slope > entry.most_slope) continue;
    if (is_blocked_by(candidates_[entry.candidate], line)) return false;
  }
  return true;
}

}  // namespace cohort::geometry
