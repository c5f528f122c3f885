#pragma once

#include <functional>
#include <span>
#include <vector>

#include "server/core/snapshot.hpp"
#include "server/physics/multibody/connection.hpp"

namespace cohort::physics {

/// The connections of a world that hold, or broke in the last step, numbered from 0 in the order in which they came.
/// What was released is forgotten, so that a world in which robots grip and let go for days costs what it did.
class Connections {
 public:
  /// Returns its number. `a` is on a body that moves.
  std::uint32_t add(const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits);
  void release(std::uint32_t connection) {
    if (Connection* const found = find(connection)) found->release();
  }
  /// Those at either end of a body that moves.
  void release_of(std::uint32_t member);
  /// Those at either end of any body of the world.
  void release_of_body(std::uint32_t body);
  /// After a step, of all that hold and yield: `pose(end)` is X_WS of its segment.
  template <class PoseOf>
  void settle(PoseOf&& pose, double step) {
    for (auto& [number, connection] : connections_)
      if (connection.holds() && connection.may_slip())
        connection.settle(pose(connection.a()), pose(connection.b()), step);
  }
  void set_give(std::uint32_t connection, const ConnectionGive& give) {
    if (Connection* const found = find(connection)) found->set_give(give);
  }
  /// Releases those that the last step took beyond their limits, and forgets what was released before.
  void break_overloaded(double step);
  /// By that, ascending.
  std::span<const ConnectionId> broken() const { return broken_; }

  /// nullptr if it was released.
  const Connection* find(std::uint32_t connection) const { return const_cast<Connections&>(*this).find(connection); }
  /// How many there ever were.
  std::uint32_t made() const { return next_; }
  bool holds(std::uint32_t connection) const {
    const Connection* const found = find(connection);
    return found != nullptr && found->holds();
  }
  /// Calls `visit(connection)` for those that hold and whose end a is on this body, ascending.
  template <class Visit>
  void for_each_of(std::uint32_t member, Visit&& visit) {
    if (member >= of_member_.size()) return;
    for (const std::uint32_t number : of_member_[member])
      if (Connection* const found = find(number); found != nullptr && found->holds()) visit(*found);
  }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// In the place of what there is. Throws SnapshotError if a connection has an end that is not there.
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
  std::vector<std::vector<std::uint32_t>> of_member_;  // of end a, ascending
  std::vector<ConnectionId> broken_;
};

/// Whether there is such an end: a link of one of the `bodies`, on its segment `segment_of(body, link)` if it moves.
template <class Body, class Models, class SegmentOf>
bool is_there(const Connection::End& end, const std::vector<Body>& bodies, const Models& models,
              SegmentOf&& segment_of) {
  if (end.body >= bodies.size() || bodies[end.body].member != end.member) return false;
  if (end.link >= models[bodies[end.body].model].links.size()) return false;
  return end.member == Anchors::nobody || end.segment == segment_of(end.body, end.link);
}

}  // namespace cohort::physics
