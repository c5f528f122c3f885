// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/collision.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "server/core/state_visitors.hpp"
#include "server/physics/contact/closed_form_contact.hpp"
#include "server/physics/contact/same_point.hpp"

namespace cohort::physics {
namespace {

// One narrow phase serves all worlds: it has no state, and takes more memory than a small world.
BulletNarrowPhase& narrow_phase() {
  static BulletNarrowPhase shared(Collision::margin);
  return shared;
}

}  // namespace

Collision::Collision(const geometry::Scene& scene, MayTouch may_touch)
    : scene_(scene), may_touch_(std::move(may_touch)) {}

void Collision::add(std::shared_ptr<const BulletShape> shape, bool moves) {
  shapes_.push_back(std::move(shape));
  place_.push_back(moves ? static_cast<std::uint32_t>(moving_.size()) : nowhere);
  if (moves) moving_.emplace_back();
}

void Collision::reserve(std::size_t solids) {
  shapes_.reserve(solids);
  place_.reserve(solids);
}

void Collision::remove(std::uint32_t solid) {
  if (moves(solid)) {
    moving_[place_[solid]].pairs.clear();
    moving_[place_[solid]].way_W.setZero();
  }
  for (Moving& moving : moving_) std::erase_if(moving.pairs, [&](const SolidPair& pair) { return pair.b == solid; });
}

void Collision::detect(std::uint32_t solid, std::span<const std::uint32_t> near) {
  find_pairs(solid, near);
  for (SolidPair& pair : pairs_of(solid)) {
    find_contact(pair);
    if (!is_fast(solid)) continue;
    if (pair.contact.count == 0)
      find_contact_on_the_way(pair);
    else if (pair.general)
      add_points_beside(scene_.solid(solid).X_WC, solid, pair.b, pair.contact);
  }
}

geometry::Bounds Collision::region_along(std::uint32_t solid, const Eigen::Vector3d& way_W) const {
  geometry::Bounds region = scene_.bounds(solid).grown_by(margin);
  region.lower += way_W.cwiseMin(0.0);
  region.upper += way_W.cwiseMax(0.0);
  return region;
}

bool Collision::reports(std::uint32_t solid, std::uint32_t other) const {
  if (!moves(other)) return true;
  if (is_asleep(solid) != is_asleep(other)) return is_asleep(other);
  return is_fast(solid) == is_fast(other) ? solid < other : is_fast(solid);
}

bool Collision::makes_a_pair(std::uint32_t solid, std::uint32_t other) const {
  if (!reports(solid, other) || !may_collide(scene_.solid(solid).surface(), scene_.solid(other).surface()))
    return false;
  if (!scene_.reaches_into(other, region_along(solid, way_of(solid) - way_of(other)))) return false;
  return scene_.solid(other).body != scene_.solid(solid).body || may_touch_(solid, other);
}

// Pairs that are still near keep their contact points.
void Collision::find_pairs(std::uint32_t solid, std::span<const std::uint32_t> near) {
  assert(std::ranges::is_sorted(near));
  std::vector<SolidPair>& pairs = moving_[place_[solid]].pairs;
  std::size_t same = 0;
  bool is_same = true;
  for (const std::uint32_t other : near) {
    if (!makes_a_pair(solid, other)) continue;
    is_same = is_same && same < pairs.size() && pairs[same].b == other;
    ++same;
  }
  if (is_same && same == pairs.size()) return;

  std::vector<SolidPair> next;
  next.reserve(same);
  auto old = pairs.begin();
  for (const std::uint32_t other : near) {
    if (!makes_a_pair(solid, other)) continue;
    while (old != pairs.end() && old->b < other) ++old;
    if (old != pairs.end() && old->b == other) {
      next.push_back(std::move(*old));
    } else {
      next.push_back({.a = solid, .b = other, .contact = {}, .general = {}});
    }
  }
  pairs = std::move(next);
}

void Collision::find_contact(SolidPair& pair) {
  const geometry::Solid& a = scene_.solid(pair.a);
  const geometry::Solid& b = scene_.solid(pair.b);
  ContactPoints found;
  const Eigen::Vector3d last_normal_W =
      pair.contact.count > 0 ? pair.contact.points[0].normal_W : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (find_closed_form_contact(a.shape(), a.X_WC, b.shape(), b.X_WC, margin, last_normal_W, found)) {
    pair.general.reset();
    match_points(pair.contact, found, [](const ContactPoint& old, ContactPoint& point) {
      point.impulse = old.impulse;
      point.rolling_impulse = old.rolling_impulse;
      point.spinning_impulse = old.spinning_impulse;
    });
    pair.contact = found;
    return;
  }
  if (!pair.general) {
    pair.general.emplace(narrow_phase(), shapes_[pair.a], shapes_[pair.b]);
    pair.contact.count = 0;
  }
  pair.general->update(a.X_WC, b.X_WC, pair.contact);
}

// Returns the contact of two solids that were apart, with the first one at X_WA instead of its present pose.
ContactPoints Collision::contact_at(const Pose& X_WA, std::uint32_t solid, std::uint32_t other) const {
  const geometry::Solid& b = scene_.solid(other);
  ContactPoints found;
  if (!find_closed_form_contact(scene_.solid(solid).shape(), X_WA, b.shape(), b.X_WC, margin, Eigen::Vector3d::Zero(),
                                found))
    BulletContact(narrow_phase(), shapes_[solid], shapes_[other]).update(X_WA, b.X_WC, found);
  return found;
}

// Adds further contact points of a fast solid at once, each found with the solid rotated a little towards it. Bullet
// finds one point per step and its neighbours in the next steps; a face that hits with one corner alone would meanwhile
// turn past the obstacle. A ball has only one point.
void Collision::add_points_beside(const Pose& X_WA, std::uint32_t solid, std::uint32_t other,
                                  ContactPoints& found) const {
  if (found.count > 2 || std::holds_alternative<description::Sphere>(scene_.solid(solid).shape())) return;
  constexpr double little = 0.01;  // [rad]
  constexpr double askew = 0.46;   // keeps edges from being level [rad]
  constexpr double alike = 0.999;  // cosine of the angle between normals
  const Eigen::Vector3d way_W = way_of(solid) - way_of(other);
  const auto is_more_against = [&](const ContactPoint& one, const ContactPoint& two) {
    return one.normal_W.dot(way_W) < two.normal_W.dot(way_W);
  };
  const Eigen::Vector3d normal_W = std::ranges::min_element(found, is_more_against)->normal_W;
  const double apart = 0.5 * furthest_unseen(solid);
  ContactPoints beside;
  const auto add = [&](const Eigen::Vector3d& position_W, double gap) {
    const auto is_near = [&](const ContactPoint& point) { return (point.position_W - position_W).norm() < apart; };
    if (std::ranges::none_of(beside, is_near)) beside.add(position_W, normal_W, gap);
  };
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::AngleAxisd around(askew + 0.5 * M_PI * quarter, normal_W);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(little, around * normal_W.unitOrthogonal()));
    for (const ContactPoint& turned : contact_at({X_WA.position, turn * X_WA.orientation}, solid, other)) {
      const Eigen::Vector3d position_W = X_WA.position + turn.conjugate() * (turned.position_W - X_WA.position);
      if (turned.normal_W.dot(normal_W) > alike)
        add(position_W, turned.gap + normal_W.dot(position_W - turned.position_W));
    }
  }
  for (const ContactPoint& point : found)
    if (point.normal_W.dot(normal_W) > alike) add(point.position_W, point.gap);
  found = beside;
}

// Returns the first contact on the way. The sampled positions are so close together that the other solid cannot be
// missed between them.
Collision::Touch Collision::first_touch(std::uint32_t solid, std::uint32_t other, const Eigen::Vector3d& way_W) const {
  const Pose& X_WA = scene_.solid(solid).X_WC;
  const auto pose_at = [&](double share) { return Pose{X_WA.position + share * way_W, X_WA.orientation}; };
  double spacing = furthest_unseen(solid);
  if (is_fast(other)) spacing = std::min(spacing, furthest_unseen(other));
  const double places = std::min(most_places, std::ceil(way_W.norm() / spacing));
  double apart = 0.0;
  Touch touch{0.0, {}};
  for (double place = 1.0; place <= places && touch.points.count == 0; ++place) {
    apart = touch.share;
    touch.share = place / places;
    touch.points = contact_at(pose_at(touch.share), solid, other);
  }
  const auto overlap = [&] {
    return std::ranges::any_of(touch.points, [](const ContactPoint& point) { return point.gap < 0.0; });
  };
  for (int halving = 0; halving < 6 && overlap(); ++halving) {
    const double middle = 0.5 * (apart + touch.share);
    const ContactPoints there = contact_at(pose_at(middle), solid, other);
    if (there.count == 0)
      apart = middle;
    else
      touch = {middle, there};
  }
  return touch;
}

// Finds where two solids will touch that are now apart, if one is so fast that they may have passed through each other
// at the end of the step.
void Collision::find_contact_on_the_way(SolidPair& pair) {
  const Eigen::Vector3d way_W = way_of(pair.a) - way_of(pair.b);  // a relative to b
  Touch touch = first_touch(pair.a, pair.b, way_W);
  if (touch.points.count == 0) return;
  const Pose& X_WA = scene_.solid(pair.a).X_WC;
  add_points_beside({X_WA.position + touch.share * way_W, X_WA.orientation}, pair.a, pair.b, touch.points);
  // Give the points relative to a's present pose. Each of the two covers a share of the way to the meeting point
  // proportional to its speed.
  const double of_a = way_of(pair.a).norm() / (way_of(pair.a).norm() + way_of(pair.b).norm());
  for (const ContactPoint& point : touch.points) {
    const double closes = -touch.share * point.normal_W.dot(way_W);
    if (closes > 0.0)
      pair.contact.add(point.position_W - of_a * touch.share * way_W, point.normal_W, point.gap + closes);
  }
}

double Collision::free_share(std::uint32_t solid, const Eigen::Vector3d& way_W) const {
  if (!((way_W - way_of(solid)).norm() > furthest_unseen(solid))) return 1.0;  // as predicted, or not a number
  double share = 1.0;
  scene_.for_each_static_overlap(region_along(solid, way_W), [&](std::uint32_t other) {
    if (!may_collide(scene_.solid(solid).surface(), scene_.solid(other).surface())) return;
    const auto touches = [&](const SolidPair& pair) { return pair.b == other && pair.contact.count > 0; };
    if (std::ranges::any_of(pairs_of(solid), touches)) return;  // the solver already handles it
    const Touch touch = first_touch(solid, other, way_W);
    if (touch.points.count > 0) share = std::min(share, touch.share);
  });
  return share;
}

void Collision::save(SnapshotWriter& writer) const {
  writer.add_count(place_.size());
  for (std::uint32_t solid = 0; solid < place_.size(); ++solid) {
    const std::span<const SolidPair> pairs = moves(solid) ? pairs_of(solid) : std::span<const SolidPair>();
    writer.add_count(pairs.size());
    for (const SolidPair& pair : pairs) {
      writer.add(pair.b);
      writer.add(pair.contact.count);
      for (const ContactPoint& point : pair.contact) ContactPoint::visit_state(point, StateSaver{writer});
      writer.add(pair.general.has_value());
      if (pair.general) pair.general->save(writer);
    }
  }
}

void Collision::restore(SnapshotReader& reader) {
  reader.expect_count(place_.size(), "solids");
  for (std::uint32_t solid = 0; solid < place_.size(); ++solid) {
    if (!moves(solid)) {
      reader.expect_count(0, "contacts of a static solid");
      continue;
    }
    std::vector<SolidPair>& pairs = moving_[place_[solid]].pairs;
    pairs.clear();
    constexpr std::size_t least_bytes = 9;
    for (std::size_t count = reader.read_count(least_bytes); count > 0; --count) {
      SolidPair& pair = pairs.emplace_back();
      pair.a = solid;
      reader.read(pair.b);
      reader.read(pair.contact.count);
      if (pair.b >= place_.size() || pair.contact.count < 0 || pair.contact.count > ContactPoints::most)
        throw SnapshotError("snapshot: invalid contact");
      for (ContactPoint& point : pair.contact) ContactPoint::visit_state(point, StateRestorer{reader});
      bool is_general = false;
      reader.read(is_general);
      if (!is_general) continue;
      pair.general.emplace(narrow_phase(), shapes_[pair.a], shapes_[pair.b]);
      pair.general->restore(scene_.solid(pair.a).X_WC, scene_.solid(pair.b).X_WC, reader);
    }
  }
}

}  // namespace cohort::physics
