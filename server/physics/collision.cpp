#include "server/physics/collision.hpp"

#include <algorithm>
#include <array>

#include "server/physics/closed_form_contact.hpp"

namespace cohort::physics {
namespace {

// Points this near count as touching for the solver, which lets them close the gap within the step [m].
constexpr double contact_margin = 0.005;

constexpr std::size_t solids_a_chunk = 32;

// A point may move this far from one step to the next and still be the same [m].
constexpr double same_point = 0.01;

// Each point starts from the impulses of the nearest one of the last step.
void take_over_impulses(const ContactPoints& before, ContactPoints& now) {
  std::array<bool, ContactPoints::most> taken{};
  for (ContactPoint& point : now) {
    double nearest = same_point * same_point;
    int best = -1;
    for (int i = 0; i < before.count; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const double distance = (before.points[index].position_W - point.position_W).squaredNorm();
      if (taken[index] || distance >= nearest) continue;
      nearest = distance;
      best = i;
    }
    if (best < 0) continue;
    const auto index = static_cast<std::size_t>(best);
    taken[index] = true;
    point.impulse = before.points[index].impulse;
    point.rolling_impulse = before.points[index].rolling_impulse;
  }
}

}  // namespace

Collision::Collision(const geometry::Scene& scene, MayTouch may_touch)
    : scene_(scene), may_touch_(std::move(may_touch)), narrow_phase_(contact_margin) {}

void Collision::add(std::shared_ptr<const BulletShape> shape) {
  const auto solid = static_cast<std::uint32_t>(shapes_.size());
  if (scene_.solid(solid).moves) moving_.push_back(solid);
  shapes_.push_back(std::move(shape));
  pairs_.emplace_back();
}

void Collision::remove(std::uint32_t solid) {
  std::erase(moving_, solid);
  pairs_[solid].clear();
  for (std::vector<SolidPair>& pairs : pairs_)
    std::erase_if(pairs, [&](const SolidPair& pair) { return pair.b == solid; });
}

void Collision::detect(WorkerPool& workers) {
  workers.for_each_chunk(moving_.size(), solids_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      find_pairs(moving_[i], near);
      for (SolidPair& pair : pairs_[moving_[i]]) find_contact(pair);
    }
  });
}

// Old pairs that are still near keep what they know.
void Collision::find_pairs(std::uint32_t solid, std::vector<std::uint32_t>& near) {
  near.clear();
  const geometry::Solid& one = scene_.solid(solid);
  scene_.for_each_overlap(scene_.bounds(solid).grown_by(contact_margin), [&](std::uint32_t other) {
    const geometry::Solid& two = scene_.solid(other);
    if (two.moves && other <= solid) return;  // the other one reports it
    if (two.body == one.body && !may_touch_(solid, other)) return;
    near.push_back(other);
  });
  std::sort(near.begin(), near.end());

  std::vector<SolidPair>& pairs = pairs_[solid];
  const auto is_same = [](const SolidPair& pair, std::uint32_t other) { return pair.b == other; };
  if (std::equal(pairs.begin(), pairs.end(), near.begin(), near.end(), is_same)) return;
  std::vector<SolidPair> next;
  next.reserve(near.size());
  auto old = pairs.begin();
  for (const std::uint32_t other : near) {
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
  if (find_closed_form_contact(a.shape, a.X_WC, b.shape, b.X_WC, contact_margin, found)) {
    pair.general.reset();
    take_over_impulses(pair.contact, found);
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
