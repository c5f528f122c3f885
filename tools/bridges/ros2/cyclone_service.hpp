// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/cdr.hpp"
#include "tools/bridges/ros2/robots/ros_inbox.hpp"
#include "tools/bridges/ros2/simulation/simulation_services.hpp"

namespace cohort::ros2 {

/// A request from a client that uses Cyclone DDS, as sent by rmw_cyclonedds.
struct CycloneRequest {
  std::array<std::byte, 16> header{};  ///< returned with the reply: the client's writer and the number of the request
  std::string client{};                ///< `clientid` in the user data of the client's writer and reader
  messages::Bytes request{};           ///< without the header
};

/// The endpoints of a service for clients that use Cyclone DDS, which are recognised by their user data. Clients on
/// other DDS implementations use the same topics, but mark their requests in another way. A second writer makes clients
/// on Fast DDS wait for the helper (OfferService::is_shared).
class CycloneService {
 public:
  /// Requests are put into `inbox` as messages of `input`. The inbox is also woken when replies that had to wait may be
  /// sent. Throws wire::WireError.
  CycloneService(RosParticipant& participant, RosInbox& inbox, const OfferedService& service, std::size_t input);

  /// Returns the request in a message of the inbox; nullopt if its client does not use Cyclone DDS.
  std::optional<CycloneRequest> request(const RosInbox::Message& message) const;
  /// Returns whether a client can receive replies yet.
  bool is_there(const std::string& client) const;
  /// Sends a reply. `reply` is in CDR, without the header. Throws wire::WireError.
  void reply(const CycloneRequest& to, messages::ByteView reply);

 private:
  RosWriter writer_;
  RosWriter counted_writer_;  // never writes
  RosReader reader_;
};

}  // namespace cohort::ros2
