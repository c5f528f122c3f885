#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort {

/// Sends the requests of docs/protocol.md, "Control", and waits for their replies: what Control and Observer stand on.
/// Requests are asked again until their reply comes; the server does each once. One thread uses it.
class ControlClient {
 public:
  /// Does not wait for the server. Throws wire::WireError if its address or the identity cannot be used.
  explicit ControlClient(const ControlOptions& options);
  ~ControlClient();

  /// Waits until a server is there; false if none is within `at_most`, or `stop` is set.
  bool wait_for_server(std::chrono::milliseconds at_most, const std::atomic<bool>& stop);

  /// Asks and waits for the reply, whatever its result is. Nothing if none comes within `at_most`, `stop` is set, or
  /// the server goes; what was asked for may happen all the same.
  std::optional<wire::Reply> ask(wire::Operation operation, std::chrono::milliseconds at_most,
                                 const std::atomic<bool>& stop);
  /// Returns whether a server is there that takes requests.
  bool sees_server() const;
  /// A server was there, and is there no more.
  bool server_is_gone() const;

  /// Through which it asks; for readers of its owner, which must not outlive it.
  wire::Participant& participant();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Makes one. Throws ControlError (`no_attachment`) if the server's address or the identity cannot be used.
ControlClient attach(const ControlOptions& options);

}  // namespace cohort
