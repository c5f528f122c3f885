// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Messages between the ROS 2 bridge and its helper `cohort-ros2-services`. The helper has the endpoints of services
/// for clients on Fast DDS. It does not interpret requests and replies, but passes them on as on the wire.
///
/// The bridge starts the helper with a socket as its standard input and output. Each direction is a sequence of frames:
///
///     uint32 size | uint8 kind | fields, size − 1 bytes in all
///
/// Numbers have the byte order of the machine, because both processes run on one machine. A string, a list and a
/// sequence of bytes begin with a uint32, the number of elements. The bridge sends OpenDomain first, and only once. It
/// ends the helper by closing the socket. A helper that cannot go on says why on standard error and ends; the bridge
/// sees the end of the stream.
namespace cohort::bridges::ros2 {

/// Limit of a frame's size without its first four bytes, which contain the size [bytes].
inline constexpr std::size_t largest_frame = std::size_t{16} << 20;

/// The identifier that DDS gives to a participant, a reader or a writer.
using Guid = std::array<std::uint8_t, 16>;
/// CDR with its four bytes of encapsulation, or the text of USER_DATA.
using Bytes = std::string;

/// Bridge to helper: join a domain.
struct OpenDomain {
  static constexpr std::uint8_t kind = 1;
  std::uint32_t domain = 0;
  Bytes user_data{};                 ///< user data of the participant
  bool multicast = true;             ///< looks for participants by multicast, and answers it
  std::vector<std::string> peers{};  ///< IPv4 addresses at which to look for further participants
  void visit(auto&& field) { field(domain), field(user_data), field(multicast), field(peers); }
};

/// Bridge to helper: make the endpoints of a service.
struct OfferService {
  static constexpr std::uint8_t kind = 2;
  std::uint32_t service = 0;  ///< number of the service from now on
  std::string request_topic{};
  std::string request_type{};
  Bytes request_user_data{};
  std::string reply_topic{};
  std::string reply_type{};
  Bytes reply_user_data{};
  /// The bridge has endpoints of this service too, with one more writer than readers. The helper then has one more
  /// reader than writers. Clients consider a service available when they see as many readers of requests as writers of
  /// replies. Therefore they wait until they see the endpoints of both.
  bool is_shared = false;
  void visit(auto&& field) {
    field(service), field(request_topic), field(request_type), field(request_user_data), field(reply_topic),
        field(reply_type), field(reply_user_data), field(is_shared);
  }
};

/// Bridge to helper: the reply to a request.
struct SendReply {
  static constexpr std::uint8_t kind = 3;
  std::uint32_t service = 0;
  Guid client{};  ///< as in the request
  std::int64_t sequence = 0;
  Bytes reply{};
  void visit(auto&& field) { field(service), field(client), field(sequence), field(reply); }
};

/// Bridge to helper: publish a sample that replaces the last one on this topic, for present and future subscribers. It
/// tells the ROS graph which endpoints belong to which node.
struct Announce {
  static constexpr std::uint8_t kind = 4;
  std::string topic{};
  std::string type{};
  Bytes sample{};
  void visit(auto&& field) { field(topic), field(type), field(sample); }
};

/// Helper to bridge: the domain is joined.
struct DomainOpened {
  static constexpr std::uint8_t kind = 16;
  Guid participant{};
  void visit(auto&& field) { field(participant); }
};

/// Helper to bridge: a service has its endpoints.
struct ServiceOffered {
  static constexpr std::uint8_t kind = 17;
  std::uint32_t service = 0;
  Guid request_reader{};
  Guid reply_writer{};
  void visit(auto&& field) { field(service), field(request_reader), field(reply_writer); }
};

/// Helper to bridge: a request of a client.
struct RequestReceived {
  static constexpr std::uint8_t kind = 18;
  std::uint32_t service = 0;
  Guid client{};
  std::int64_t sequence = 0;
  Bytes request{};
  void visit(auto&& field) { field(service), field(client), field(sequence), field(request); }
};

using FrameToHelper = std::variant<OpenDomain, OfferService, SendReply, Announce>;
using FrameToBridge = std::variant<DomainOpened, ServiceOffered, RequestReceived>;

/// Returns the bytes of a frame, its size first. Throws std::length_error if it is larger than largest_frame.
std::string encode(const FrameToHelper& frame);
std::string encode(const FrameToBridge& frame);

/// Splits a stream of bytes into frames of one direction.
template <typename Frame>
class FrameStream {
 public:
  void append(std::string_view bytes) { bytes_.append(bytes); }
  /// Returns the next frame if it is complete. Throws std::runtime_error if the bytes are not a valid frame.
  std::optional<Frame> next();
  /// Returns whether the stream ends inside a frame.
  bool is_inside_frame() const { return begin_ < bytes_.size(); }

 private:
  std::string bytes_{};
  std::size_t begin_ = 0;  // start of the next frame
};

extern template class FrameStream<FrameToHelper>;
extern template class FrameStream<FrameToBridge>;

}  // namespace cohort::bridges::ros2
