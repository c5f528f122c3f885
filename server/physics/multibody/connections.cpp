// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/connections.hpp"

#include <algorithm>
#include <cassert>

#include "server/core/state_visitors.hpp"

namespace cohort::physics {
namespace {

template <class End, class Visit>
void visit_end(End& end, Visit&& visit) {
  visit(end.member);
  visit(end.segment);
  visit(end.link);
  visit_pose(end.X_SP, visit);
  visit(end.body);
}

}  // namespace

std::uint32_t Connections::add(const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits) {
  add(next_, a, b, limits);
  return next_++;
}

void Connections::add(std::uint32_t number, const Connection::End& a, const Connection::End& b,
                      const ConnectionLimits& limits) {
  assert(connections_.empty() || connections_.back().number < number);
  assert(a.member != b.member);
  connections_.push_back({number, Connection(a, b, limits)});
  if (of_member_.size() <= a.member) of_member_.resize(a.member + 1);
  of_member_[a.member].push_back(number);
}

Connection* Connections::find(std::uint32_t connection) {
  const auto found = std::ranges::lower_bound(connections_, connection, {}, &Numbered::number);
  return found != connections_.end() && found->number == connection ? &found->connection : nullptr;
}

void Connections::release_of(std::uint32_t member) {
  for (auto& [number, connection] : connections_)
    if (connection.a().member == member || connection.b().member == member) connection.release();
}

void Connections::release_of_body(std::uint32_t body) {
  for (auto& [number, connection] : connections_)
    if (connection.a().body == body || connection.b().body == body) connection.release();
}

void Connections::forget_released() {
  for (const auto& [number, connection] : connections_)
    if (!connection.holds()) std::erase(of_member_[connection.a().member], number);
  std::erase_if(connections_, [](const Numbered& each) { return !each.connection.holds(); });
}

void Connections::break_overloaded(double step) {
  forget_released();
  broken_.clear();
  for (auto& [number, connection] : connections_) {
    if (!connection.is_overloaded(step)) continue;
    connection.break_now();
    broken_.emplace_back(number);
  }
}

void Connections::hash(StateHash& hash) const {
  hash.add(std::uint64_t{next_});
  for (const auto& [number, connection] : connections_) {
    if (!connection.holds()) continue;
    hash.add(std::uint64_t{number});
    Connection::visit_state(connection, StateHasher{hash});
  }
}

void Connections::save(SnapshotWriter& writer) const {
  const StateSaver save{writer};
  save(next_);
  writer.add_count(connections_.size());
  for (const auto& [number, connection] : connections_) {
    save(number);
    visit_end(connection.a(), save);
    visit_end(connection.b(), save);
    save(connection.limits().force);
    save(connection.limits().torque);
    Connection::visit_state(connection, save);
  }
}

void Connections::restore(SnapshotReader& reader, const std::function<bool(const Connection::End&)>& is_there) {
  const StateRestorer restore{reader};
  connections_.clear();
  of_member_.clear();
  broken_.clear();
  restore(next_);
  constexpr std::size_t least_bytes = 100;
  for (std::size_t count = reader.read_count(least_bytes); count > 0; --count) {
    std::uint32_t number = 0;
    Connection::End a;
    Connection::End b;
    ConnectionLimits limits;
    restore(number);
    visit_end(a, restore);
    visit_end(b, restore);
    reader.read(limits.force);
    reader.read(limits.torque);
    for (const Connection::End& end : {a, b}) expect_placed(end.X_SP);
    if (a.member == Anchors::nobody || !is_there(a) || !is_there(b) || !(limits.force >= 0.0) ||
        !(limits.torque >= 0.0))
      throw SnapshotError("snapshot: invalid connection");
    if (number >= next_ || (!connections_.empty() && number <= connections_.back().number))
      throw SnapshotError("snapshot: the connections are out of order");
    add(number, a, b, limits);
    Connection::visit_state(connections_.back().connection, StateRestorer{reader, StateRestorer::Numbers::limits});
  }
}

}  // namespace cohort::physics
