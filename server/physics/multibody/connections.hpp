// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "server/core/snapshot.hpp"
#include "server/physics/multibody/connection.hpp"

namespace cohort::physics {

/// The connections of a world that hold or broke in the last step, numbered from 0 in the order of their creation.
/// Released ones are forgotten, so that the cost of a world stays constant when robots grip and release for days.
class Connections {
 public:
  /// Adds a connection and returns its number. `a` must be on a moving body.
  std::uint32_t add(const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits);
  void release(std::uint32_t connection) {
    if (Connection* const found = find(connection)) found->release();
  }
  /// Releases the connections of a moving body, at either end.
  void release_of(std::uint32_t member);
  /// Releases the connections of any body of the world, at either end.
  void release_of_body(std::uint32_t body);
  /// Settles all compliant connections that hold, after a step. `pose(end)` returns X_WS of its segment.
  template <class PoseOf>
  void settle(PoseOf&& pose, double step) {
    for (auto& [number, connection] : connections_)
      if (connection.holds() && connection.may_slip())
        connection.settle(pose(connection.a()), pose(connection.b()), step);
  }
  void set_give(std::uint32_t connection, const ConnectionGive& give) {
    if (Connection* const found = find(connection)) found->set_give(give);
  }
  /// Releases connections that the last step loaded beyond their limits, and forgets those that were released before.
  void break_overloaded(double step);
  /// Returns the connections that `break_overloaded` released, in ascending order.
  std::span<const ConnectionId> broken() const { return broken_; }

  /// Returns a connection, or nullptr if it was released.
  const Connection* find(std::uint32_t connection) const { return const_cast<Connections&>(*this).find(connection); }
  /// Returns the number of connections ever made.
  std::uint32_t made() const { return next_; }
  bool holds(std::uint32_t connection) const {
    const Connection* const found = find(connection);
    return found != nullptr && found->holds();
  }
  /// Calls `visit(connection)` in ascending order for those that hold and whose end a is on this body.
  template <class Visit>
  void for_each_of(std::uint32_t member, Visit&& visit) {
    if (member >= of_member_.size()) return;
    for (const std::uint32_t number : of_member_[member])
      if (Connection* const found = find(number); found != nullptr && found->holds()) visit(*found);
  }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// Replaces all connections by those of a snapshot. Throws SnapshotError if an end of a connection does not exist.
  void restore(SnapshotReader& reader, const std::function<bool(const Connection::End&)>& is_there);

 private:
  struct Numbered {
    std::uint32_t number = 0;
    Connection connection;
  };
  Connection* find(std::uint32_t connection);
  void add(std::uint32_t number, const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits);
  void forget_released();

  std::vector<Numbered> connections_;  // ascending
  std::uint32_t next_ = 0;
  std::vector<std::vector<std::uint32_t>> of_member_;  // by the member of end a, ascending
  std::vector<ConnectionId> broken_;
};

/// Returns whether such an end exists: a link of one of the `bodies`, on its segment `segment_of(body, link)` if it
/// moves.
template <class Body, class Models, class SegmentOf>
bool is_there(const Connection::End& end, const std::vector<Body>& bodies, const Models& models,
              SegmentOf&& segment_of) {
  if (end.body >= bodies.size() || bodies[end.body].member != end.member) return false;
  if (end.link >= models[bodies[end.body].model].links.size()) return false;
  return end.member == Anchors::nobody || end.segment == segment_of(end.body, end.link);
}

}  // namespace cohort::physics
