// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort {

/// Sends the requests of docs/protocol.md, "Control", and waits for their replies; the base of Control and Observer.
/// Requests are sent again until their reply arrives; the server performs each once. For one thread.
class ControlClient {
 public:
  /// Does not wait for the server. Throws wire::WireError if its address or the identity cannot be used.
  explicit ControlClient(const ControlOptions& options);
  ~ControlClient();

  /// Waits for a server; returns false if none is there within `at_most`, or if `stop` is set.
  bool wait_for_server(std::chrono::milliseconds at_most, const std::atomic<bool>& stop);

  /// Sends a request and returns its reply, with any result. Returns nothing if none arrives within `at_most`, if
  /// `stop` is set, or if the server is gone; the server may still perform the request.
  std::optional<wire::Reply> ask(wire::Operation operation, std::chrono::milliseconds at_most,
                                 const std::atomic<bool>& stop);
  /// Returns true if there is a server that accepts requests.
  bool sees_server() const;
  /// Returns true if there was a server and it is gone.
  bool server_is_gone() const;

  /// Returns the participant that sends the requests, for further readers, which must not outlive this object.
  wire::Participant& participant();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Creates a client. Throws ControlError (`no_attachment`) if the server's address or the identity cannot be used.
ControlClient attach(const ControlOptions& options);

}  // namespace cohort
