// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>

#include "idl/dds/dds.hpp"

/// DDS topics whose samples are CDR bytes that Cyclone DDS neither encodes nor decodes. So the encoder of idl/messages
/// serves both the network and recordings, and types need no generated code.
namespace cohort::ros2 {

/// A received sample.
struct OpaqueSample {
  std::span<const std::byte> bytes;  ///< including the encapsulation; valid during the call
  std::uint64_t publication = 0;     ///< handle of its writer
};

/// A topic with a type of this name and without a key.
class OpaqueTopic {
 public:
  /// `name` and `type` are those of DDS, such as `rt/odom` and `nav_msgs::msg::dds_::Odometry_`. Throws WireError.
  OpaqueTopic(dds_entity_t participant, const std::string& name, const std::string& type);

  dds_entity_t handle() const { return topic_.handle(); }
  const ddsi_sertype* type() const { return type_; }
  /// Sends a message in CDR. Returns false if it was dropped because readers took too long for earlier ones. Throws
  /// WireError.
  bool write(dds_entity_t writer, std::span<const std::byte> bytes) const;

 private:
  wire::Entity topic_;
  const ddsi_sertype* type_;  // type of the topic
};

/// Calls `take` with all samples that the reader has received.
void take_opaque(dds_entity_t reader, const std::function<void(const OpaqueSample& sample)>& take);

}  // namespace cohort::ros2
