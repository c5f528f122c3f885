// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// A request and its source.
struct ReceivedRequest {
  wire::Request request;
  wire::Sender sender;
  wire::Participant* participant = nullptr;
};

/// Returns the size of a request in memory [bytes].
inline std::size_t size_of(const wire::Request& request) {
  std::size_t bytes = sizeof request + request.label.size();
  const auto add = [&](const auto& content) { bytes += content.size(); };
  std::visit(
      [&](const auto& operation) {
        wire::for_each_name(operation, add);
        wire::for_each_document(operation, add);
      },
      request.operation);
  return bytes;
}

}  // namespace cohort::session
