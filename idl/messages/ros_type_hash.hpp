// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_messages.hpp"

/// Type hashes of ROS 2 from the release Iron on (REP 2016): `RIHS01_` and the hexadecimal SHA-256 of the type's
/// description in JSON. Nodes announce the hash of each endpoint's type.
namespace cohort::messages {

/// Returns the hash of a message.
std::string type_hash(const RosDefinition& message);

template <RosMessage Message>
std::string type_hash() {
  return type_hash(definition<Message>());
}

/// A service: a struct with `Request`, `Response` and its own `type`.
template <class T>
concept RosService = RosMessage<typename T::Request> && RosMessage<typename T::Response> && requires {
  T::type;
};

/// Returns the hash of a service with this request and response.
std::string service_type_hash(const std::string& service, const RosDefinition& request, const RosDefinition& response);

template <RosService Service>
std::string type_hash() {
  return service_type_hash(Service::type, definition<typename Service::Request>(),
                           definition<typename Service::Response>());
}

}  // namespace cohort::messages
