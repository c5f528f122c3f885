#pragma once

#include <span>
#include <vector>

#include "server/core/snapshot.hpp"
#include "server/physics/multibody/connection.hpp"

namespace cohort::physics {

/// All connections of a world, also those that no longer hold, numbered from 0.
class Connections {
 public:
  /// Returns its number. `a` is on a body that moves.
  std::uint32_t add(const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits);
  void release(std::uint32_t connection) { connections_[connection].release(); }
  /// Those at either end of a body that moves.
  void release_of(std::uint32_t member);
  /// Those at either end of any body of the world.
  void release_of_body(std::uint32_t body);
  /// After a step, of all that hold and yield: `pose(end)` is X_WS of its segment.
  template <class PoseOf>
  void settle(PoseOf&& pose, double step) {
    for (Connection& connection : connections_)
      if (connection.holds() && connection.may_slip())
        connection.settle(pose(connection.a()), pose(connection.b()), step);
  }
  void set_give(std::uint32_t connection, const ConnectionGive& give) { connections_[connection].set_give(give); }
  /// Releases those that the last step took beyond their limits.
  void break_overloaded(double step);
  /// By that, ascending.
  std::span<const std::uint32_t> broken() const { return broken_; }

  const Connection& operator[](std::uint32_t connection) const { return connections_[connection]; }
  /// Calls `visit(connection)` for those that hold and whose end a is on this body, ascending.
  template <class Visit>
  void for_each_of(std::uint32_t member, Visit&& visit) {
    if (member >= of_member_.size()) return;
    for (const std::uint32_t index : of_member_[member])
      if (connections_[index].holds()) visit(connections_[index]);
  }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// In the place of what there is. Throws SnapshotError if a connection is not of one of the `members`.
  void restore(SnapshotReader& reader, std::size_t members);

 private:
  std::vector<Connection> connections_;
  std::vector<std::vector<std::uint32_t>> of_member_;  // of end a
  std::vector<std::uint32_t> broken_;
};

}  // namespace cohort::physics
