// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/dds/ros2/discovery_info.hpp"
#include "idl/dds/ros2/ros_domain.hpp"

/// A ROS 2 node on Cyclone DDS alone: on the network it behaves like a node of rmw_cyclonedds, but it needs no ROS.
/// Messages are CDR bytes (idl/messages/cdr.hpp).
namespace cohort::ros2 {

/// QoS of publishers and subscriptions in ROS; the history is `keep last`.
struct EndpointQos {
  bool is_reliable = true;
  bool is_transient_local = false;
  std::int32_t depth = 10;
};

/// The arguments of a writer or reader.
struct EndpointSpec {
  std::string topic{};      ///< name in DDS
  std::string type{};       ///< name in DDS
  std::string user_data{};  ///< announced to others
  EndpointQos qos{};
};

/// Returns the endpoint of a ROS topic. `name` is absolute, and `type` is a name such as
/// `nav_msgs/msg/Odometry`. `type_hash` is `RIHS01_…`, or empty.
EndpointSpec topic_endpoint(const std::string& name, const std::string& type, const std::string& type_hash,
                            EndpointQos qos = {});

struct ParticipantState;
class RosWriter;

/// One participant with one node in a ROS 2 domain. Must outlive its writers and readers. For one thread, except calls
/// that state otherwise.
class RosParticipant {
 public:
  struct Options {
    RosDomain domain{};
    std::string name_space = "/";
    std::string name{};
  };
  /// Throws wire::WireError.
  explicit RosParticipant(const Options& options);
  ~RosParticipant();
  RosParticipant(const RosParticipant&) = delete;
  RosParticipant& operator=(const RosParticipant&) = delete;

  Gid gid() const;

  /// Announces the node and all its present endpoints. The first call creates the writer of announcements, so a
  /// participant that has received an announcement knows all endpoints created before it.
  void announce(GidFormat format);
  /// Withdraws the announcement: later participants receive none until the next one.
  void withdraw();
  /// Returns true if these participants, in ascending order, have received the last announcement, and so know all
  /// endpoints.
  bool is_announced_to(std::span<const Gid> participants) const;

  ParticipantState& state() const { return *state_; }

 private:
  std::unique_ptr<ParticipantState> state_;
  std::unique_ptr<RosWriter> announcement_;  // destroyed first
};

/// Sends messages. Any thread may use it, one at a time.
class RosWriter {
 public:
  /// Calls `matched` on a DDS thread when readers appear or disappear. Throws wire::WireError.
  RosWriter(RosParticipant& participant, const EndpointSpec& spec, std::function<void()> matched = {});
  ~RosWriter();
  RosWriter(RosWriter&&) noexcept;
  RosWriter& operator=(RosWriter&&) noexcept;

  /// Sends a message. Returns false if it was dropped because readers took too long for earlier ones. Throws
  /// wire::WireError.
  bool write(std::span<const std::byte> message);
  /// Returns the number of readers.
  std::uint32_t readers() const;
  /// Returns true if all reliable readers have received everything.
  bool is_received() const;
  /// Returns the current participants of its readers, in ascending order; valid until the next call.
  std::span<const Gid> participants() const;
  /// Returns the current user data of its readers. Thread-safe.
  std::vector<std::string> user_data_of_readers() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A received message.
struct Received {
  std::span<const std::byte> bytes;  ///< valid during the call
  std::uint64_t writer = 0;          ///< handle for RosGraph::endpoint
};

/// Receives messages.
class RosReader {
 public:
  /// Calls `take` on a DDS thread, one message at a time; it must not throw. Calls `matched` when writers appear or
  /// disappear. Throws wire::WireError.
  RosReader(RosParticipant& participant, const EndpointSpec& spec, std::function<void(const Received&)> take,
            std::function<void()> matched = {});
  ~RosReader();
  RosReader(RosReader&&) noexcept;
  RosReader& operator=(RosReader&&) noexcept;

  /// Returns the number of writers.
  std::uint32_t writers() const;
  /// Returns the current participants of its writers, in ascending order; valid until the next call.
  std::span<const Gid> participants() const;
  /// Returns the user data of the writer of a received message (`Received::writer`); nothing if it is gone.
  /// Thread-safe.
  std::optional<std::string> user_data_of_writer(std::uint64_t writer) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::ros2
