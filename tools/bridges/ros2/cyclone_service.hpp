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

/// A request of a client on Cyclone DDS, as rmw_cyclonedds sends it.
struct CycloneRequest {
  std::array<std::byte, 16> header{};  ///< comes back with the reply: the client's writer and the number of the request
  std::string client{};                ///< `clientid` of the client's writer and reader
  messages::Bytes request{};           ///< without the header
};

/// The endpoints of a service for clients on Cyclone DDS. They are known by their user data: clients on other
/// implementations of DDS use the same topics, but mark their requests elsewhere. A second writer has clients on Fast
/// DDS wait for the helper (OfferService::is_shared).
class CycloneService {
 public:
  /// Requests go to `inbox` as messages of `input`; it is woken also when replies may go that could not before. Throws
  /// wire::WireError.
  CycloneService(RosParticipant& participant, RosInbox& inbox, const OfferedService& service, std::size_t input);

  /// Returns the request in a message of the inbox; nothing if it is of a client that is not on Cyclone DDS.
  std::optional<CycloneRequest> request(const RosInbox::Message& message) const;
  /// Returns whether a client can receive replies yet.
  bool is_there(const std::string& client) const;
  /// Sends a reply, in CDR without the header. Throws wire::WireError.
  void reply(const CycloneRequest& to, messages::ByteView reply);

 private:
  RosWriter writer_;
  RosWriter counted_writer_;  // never writes
  RosReader reader_;
};

}  // namespace cohort::ros2
