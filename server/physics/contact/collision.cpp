#include "server/physics/contact/collision.hpp"

#include <algorithm>

#include "server/physics/contact/closed_form_contact.hpp"
#include "server/physics/contact/same_point.hpp"

namespace cohort::physics {

Collision::Collision(const geometry::Scene& scene, MayTouch may_touch)
    : scene_(scene), may_touch_(std::move(may_touch)), narrow_phase_(margin) {}

void Collision::add(std::shared_ptr<const BulletShape> shape) {
  shapes_.push_back(std::move(shape));
  pairs_.emplace_back();
}

void Collision::remove(std::uint32_t solid) {
  pairs_[solid].clear();
  for (std::vector<SolidPair>& pairs : pairs_)
    std::erase_if(pairs, [&](const SolidPair& pair) { return pair.b == solid; });
}

void Collision::detect(std::uint32_t solid, std::span<const std::uint32_t> near) {
  find_pairs(solid, near);
  for (SolidPair& pair : pairs_[solid]) find_contact(pair);
}

bool Collision::makes_a_pair(std::uint32_t solid, std::uint32_t other) const {
  const geometry::Solid& two = scene_.solid(other);
  if (two.moves && other <= solid) return false;  // the other one reports it
  if (!scene_.reaches_into(other, scene_.bounds(solid).grown_by(margin))) return false;
  return two.body != scene_.solid(solid).body || may_touch_(solid, other);
}

// Old pairs that are still near keep what they know.
void Collision::find_pairs(std::uint32_t solid, std::span<const std::uint32_t> near) {
  std::vector<SolidPair>& pairs = pairs_[solid];
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
  if (find_closed_form_contact(a.shape, a.X_WC, b.shape, b.X_WC, margin, found)) {
    pair.general.reset();
    match_points(pair.contact, found, [](const ContactPoint& old, ContactPoint& point) {
      point.impulse = old.impulse;
      point.rolling_impulse = old.rolling_impulse;
    });
    pair.contact = found;
    return;
  }
  if (!pair.general) {
    pair.general.emplace(narrow_phase_, shapes_[pair.a], shapes_[pair.b]);
    pair.contact.count = 0;
  }
  pair.general->update(a.X_WC, b.X_WC, pair.contact);
}

void Collision::save(SnapshotWriter& writer) const {
  writer.add_count(pairs_.size());
  for (const std::vector<SolidPair>& pairs : pairs_) {
    writer.add_count(pairs.size());
    for (const SolidPair& pair : pairs) {
      writer.add(pair.b);
      writer.add(pair.contact.count);
      for (const ContactPoint& point : pair.contact)
        ContactPoint::visit_state(point, [&](const double& number) { writer.add(number); });
      writer.add(pair.general.has_value());
      if (pair.general) pair.general->save(writer);
    }
  }
}

void Collision::restore(SnapshotReader& reader) {
  reader.expect_count(pairs_.size(), "solids");
  for (std::uint32_t solid = 0; solid < pairs_.size(); ++solid) {
    std::vector<SolidPair>& pairs = pairs_[solid];
    pairs.clear();
    constexpr std::size_t least_bytes = 9;
    for (std::size_t count = reader.read_count(least_bytes); count > 0; --count) {
      SolidPair& pair = pairs.emplace_back();
      pair.a = solid;
      reader.read(pair.b);
      reader.read(pair.contact.count);
      if (pair.b >= pairs_.size() || pair.contact.count < 0 || pair.contact.count > ContactPoints::most)
        throw SnapshotError("the snapshot has a contact of a solid that is not there");
      for (ContactPoint& point : pair.contact)
        ContactPoint::visit_state(point, [&](double& number) { reader.read(number); });
      bool is_general = false;
      reader.read(is_general);
      if (!is_general) continue;
      pair.general.emplace(narrow_phase_, shapes_[pair.a], shapes_[pair.b]);
      pair.general->restore(scene_.solid(pair.a).X_WC, scene_.solid(pair.b).X_WC, reader);
    }
  }
}

}  // namespace cohort::physics
