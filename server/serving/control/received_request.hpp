#pragma once

#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// A request, and where it came in.
struct ReceivedRequest {
  wire::Request request;
  wire::Sender sender;
  wire::Participant* participant = nullptr;
};

/// What it takes in memory.
inline std::size_t size_of(const wire::Request& request) {
  return sizeof request + request.label.size() + request.filter.size() + request.entity.size() + request.uri.size() +
         request.resource_string.size() + request.link.size() + request.data.size();
}

}  // namespace cohort::session
