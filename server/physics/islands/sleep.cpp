// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/sleep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace cohort::physics {
namespace {

// At this speed a body moves a tenth of a millimetre, or 0.006 degrees, in 100 s; bodies at rest on contacts are much
// slower.
constexpr double still = 1e-6;  // [m/s] or [rad/s]
// Longer than any moving body is this slow, at the top of its flight or between two impacts.
constexpr double long_enough = 0.5;  // [s]

// A free body that rests on others is as slow as the solver leaves it; this is the share of the velocity that gravity
// adds in a step. Anything with joints may be meant to move slowly.
constexpr double still_share = 5e-3;

// `fall`: the velocity that gravity adds in a step.
bool is_still(const Member& member, double fall) {
  if (!member.is_finite || !member.is_inside) return false;
  const Multibody& body = *member.multibody;
  const bool is_free = body.mechanism().is_free_body();
  const double slow = is_free ? std::max(still, still_share * fall) : still;
  double slow_turn = slow;  // [rad/s]: as fast at the radius of gyration
  if (is_free) {
    const Segment& segment = body.mechanism().segments()[0];
    slow_turn = std::max(still, slow / std::sqrt(segment.inertia_S.diagonal().maxCoeff() / segment.mass));
  }
  const auto is_slow = [&](double velocity) { return std::abs(velocity) < slow; };
  const double* velocities = body.motion().velocities();
  for (int i = 0; i < body.mechanism().dof_count(); ++i)
    if (std::abs(velocities[i]) >= (is_free && i < 3 ? slow_turn : slow)) return false;
  return std::ranges::all_of(body.treels(), [&](const TrackRows& treel) {
    return is_slow(treel.track(Side::left).velocity) && is_slow(treel.track(Side::right).velocity);
  });
}

}  // namespace

Sleep::Sleep(Assembly& assembly)
    : assembly_(assembly), enough_(static_cast<std::uint32_t>(std::ceil(long_enough / assembly.step))) {}

void Sleep::count(std::uint32_t index) {
  Member& member = assembly_.members[index];
  const double fall = assembly_.step * assembly_.gravity.norm();
  member.still_steps = is_still(member, fall) ? std::min(member.still_steps + 1, enough_) : 0;
}

// Bodies with air or water forces, with measured forces or with a slipping connection do not sleep: more than their
// pose changes.
bool Sleep::may_sleep(std::uint32_t index) const {
  const Member& member = assembly_.members[index];
  if (!member.is_awake() || member.still_steps < enough_ || member.fluid || member.record) return false;
  if (!member.multibody->mechanism().model().may_sleep) return false;
  bool slips = false;
  assembly_.connections.for_each_of(index, [&](const Connection& held) { slips = slips || held.may_slip(); });
  return !slips;
}

void Sleep::fall_asleep(const Islands& islands) {
  if (!assembly_.settings.sleeping) return;
  for (const ConnectionId broken : assembly_.connections.broken()) wake_ends(broken.value);
  for (std::uint32_t island = 0; island < islands.count(); ++island) {
    const std::span<const std::uint32_t> members = islands.members(island);
    if (std::ranges::all_of(members, [&](std::uint32_t member) { return may_sleep(member); })) put_to_sleep(members);
  }
}

void Sleep::put_to_sleep(std::span<const std::uint32_t> members) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    Member& member = assembly_.members[members[i]];
    assert(member.is_awake());
    member.multibody->motion().stop();
    member.next_asleep = members[(i + 1) % members.size()];
    assembly_.set_asleep(members[i], true);
  }
}

std::vector<std::uint32_t> Sleep::group_of(std::uint32_t index) const {
  assert(assembly_.members[index].is_asleep);
  std::vector<std::uint32_t> group;
  do {
    group.push_back(index);
    index = assembly_.members[index].next_asleep;
  } while (index != group.front());
  return group;
}

void Sleep::check_groups() const {
  const std::vector<Member>& members = assembly_.members;
  std::vector<bool> is_next(members.size(), false);
  for (const Member& member : members) {
    if (!member.is_asleep) continue;
    const std::uint32_t next = member.next_asleep;
    if (next >= members.size() || !members[next].is_asleep || is_next[next])
      throw SnapshotError("snapshot: invalid group of sleeping bodies");
    is_next[next] = true;
  }
}

void Sleep::wake(std::uint32_t index) {
  assembly_.members[index].still_steps = 0;
  while (assembly_.members[index].is_asleep) {
    assembly_.members[index].still_steps = 0;
    assembly_.set_asleep(index, false);
    index = assembly_.members[index].next_asleep;
  }
}

void Sleep::wake_ends(std::uint32_t number) {
  const Connection* const connection = std::as_const(assembly_.connections).find(number);
  if (connection == nullptr) return;
  for (const Connection::End& end : {connection->a(), connection->b()})
    if (end.member != Anchors::nobody) wake(end.member);
}

void Sleep::wake_all() {
  for (std::uint32_t member = 0; member < assembly_.members.size(); ++member) wake(member);
}

}  // namespace cohort::physics
