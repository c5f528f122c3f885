// SPDX-License-Identifier: Apache-2.0
#include "server/lockstep/leases.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace cohort::lockstep {
namespace {

constexpr std::chrono::seconds trusted_for{1};  // the lease duration of the DDS liveliness
constexpr std::size_t most_news = 64;

}  // namespace

std::uint64_t Leases::answers_of_holder(std::uint32_t robot) const {
  if (!holder_[robot]) return 0;
  const auto found = answers_.find(*holder_[robot]);
  return found == answers_.end() ? 0 : found->second;
}

void Leases::claim(std::uint64_t client, std::vector<std::uint32_t> robots) {
  std::erase_if(claims_, [&](const Claim& claim) { return claim.client == client; });
  Claim claim{client, std::move(robots), {}};
  for (const std::uint32_t robot : claim.robots) claim.answers_before.push_back(answers_of_holder(robot));
  claims_.push_back(std::move(claim));
}

void Leases::change(std::uint64_t client, std::vector<std::uint32_t> robots) {
  Lease& lease = leases_.at(client);
  lease.epoch = next_epoch_++;
  for (const std::uint32_t robot : lease.robots) holder_[robot].reset();
  lease.robots = std::move(robots);
  for (const std::uint32_t robot : lease.robots) {
    assert(!holder_[robot]);
    holder_[robot] = client;
  }
}

bool Leases::decide_one(const Claim& claim, Time now, bool may_grant, Decisions& decisions) {
  std::vector<std::uint64_t> superseded;
  bool waits = false;
  for (std::size_t i = 0; i < claim.robots.size(); ++i) {
    const std::uint32_t robot = claim.robots[i];
    if (!holder_[robot] || holder_[robot] == claim.client) continue;
    if (is_dead(leases_.at(*holder_[robot]), now)) {
      if (std::ranges::find(superseded, *holder_[robot]) == superseded.end()) superseded.push_back(*holder_[robot]);
      continue;
    }
    if (answers_of_holder(robot) > claim.answers_before[i]) {
      decisions.refused.push_back({claim.client, robot, *holder_[robot]});
      return true;
    }
    waits = true;
  }
  if (waits || !may_grant) return false;

  const Lease* before = lease(claim.client);
  const bool again = before != nullptr && before->robots == claim.robots;
  const std::uint64_t epoch = again ? before->epoch : next_epoch_++;
  for (const std::uint64_t client : superseded) end_lease(client);
  end_lease(claim.client);
  leases_[claim.client] = {.epoch = epoch, .robots = claim.robots};
  for (const std::uint32_t robot : claim.robots) {
    assert(!holder_[robot]);
    holder_[robot] = claim.client;
  }
  decisions.granted.push_back({claim.client, std::move(superseded), again});
  return true;
}

const Leases::Lease* Leases::lease(std::uint64_t client) const {
  const auto found = leases_.find(client);
  return found == leases_.end() ? nullptr : &found->second;
}

void Leases::note_answer(std::uint64_t client, Time now, std::uint64_t tick, std::uint32_t copy) {
  ++answers_[client];
  const auto found = leases_.find(client);
  if (found == leases_.end()) return;
  if (!found->second.alive) found->second.heard_until = now + trusted_for;
  found->second.answered_at = now;
  found->second.answered_tick = tick;
  found->second.answered_copy = copy;
  ++found->second.answer_count;
  if (found->second.news.size() < most_news) found->second.news.push_back({tick, now});
}

void Leases::set_alive(std::uint64_t client, bool alive) {
  const auto found = leases_.find(client);
  if (found == leases_.end()) return;
  found->second.alive = alive;
  found->second.heard_until = Time{0};
}

void Leases::release(std::uint64_t client) {
  std::erase_if(claims_, [&](const Claim& claim) { return claim.client == client; });
  end_lease(client);
}

void Leases::end_lease(std::uint64_t client) {
  const auto found = leases_.find(client);
  if (found == leases_.end()) return;
  for (const std::uint32_t robot : found->second.robots) {
    assert(holder_[robot] == client);
    holder_[robot].reset();
  }
  leases_.erase(found);
  answers_.erase(client);
}

}  // namespace cohort::lockstep
