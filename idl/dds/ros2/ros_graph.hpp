// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/dds/ros2/discovery_info.hpp"

namespace cohort::ros2 {

class RosParticipant;

/// A writer or reader of another program, as reported by DDS.
struct RosEndpoint {
  Gid gid{};
  Gid participant{};
  bool is_writer = false;
  std::string topic{};      ///< name in DDS
  std::string type{};       ///< name in DDS
  std::string user_data{};  ///< `typehash=…;` and similar
  bool is_reliable = false;
  bool is_transient_local = false;
};

/// Endpoints and nodes of other programs in a ROS 2 domain. Thread-safe.
class RosGraph {
 public:
  /// Starts to observe. Calls `changed` on DDS threads when endpoints or names appear or disappear.
  RosGraph(RosParticipant& participant, std::function<void()> changed);
  ~RosGraph();
  RosGraph(const RosGraph&) = delete;
  RosGraph& operator=(const RosGraph&) = delete;

  /// Returns the endpoints of other programs, in the order of their GUIDs.
  std::vector<RosEndpoint> endpoints() const;
  /// Returns the endpoint with a handle of DDS; nothing if it is gone.
  std::optional<RosEndpoint> endpoint(std::uint64_t handle) const;
  /// Returns the names of the nodes of a participant, such as `/slam and /nav`; if it has none, a part of its GUID.
  std::string nodes_of(const Gid& participant) const;
  /// Returns true if a participant has announced its nodes.
  bool knows_nodes_of(const Gid& participant) const;
  /// Returns true if a participant has endpoints. One that has none is gone.
  bool has(const Gid& participant) const;
  /// Returns the number of nodes of other programs.
  std::size_t node_count() const;
  /// Returns true if every endpoint that nodes of other programs have announced is known here.
  bool is_complete() const;
  /// Returns the participants of other programs that have announced nodes, in ascending order.
  std::vector<Gid> participants() const;
  /// Excludes a participant from now on, such as another one of this program.
  void leave_out(const Gid& participant);
  /// Returns those of the participants that listen to announcements: ROS 2 nodes do, firmware agents do not.
  std::vector<Gid> listeners(std::span<const Gid> participants) const;
  /// Returns the format of Gids in other programs; nothing if none has announced nodes. Ignores participants with a
  /// node of the same name as this one, because they also adapt their format to the others.
  std::optional<GidFormat> gid_format() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::ros2
