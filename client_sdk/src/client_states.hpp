// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client_sdk/hosting/frame_handler.hpp"
#include "client_sdk/hosting/state_parts.hpp"
#include "idl/dds/transport.hpp"

namespace cohort {

/// The client side of "State of controllers" in docs/protocol.md: sends the state of its controllers to a server on
/// request, and fetches their state in a snapshot. Runs on the thread that uses the controllers.
class ClientStates {
 public:
  /// Calls `wake` on DDS threads when there is something to do.
  ClientStates(wire::Participant& participant, std::uint64_t client, std::function<void()> wake);

  /// Returns false if the permissions of the identity do not cover the topic; the client then works without saved
  /// states.
  bool are_possible() const { return writer_.has_value(); }

  /// Begins a lease, after its controllers have been started.
  void begin(const wire::Admit& admit);
  /// Returns true if frames must wait until the controllers have their state.
  bool are_awaited() const { return fetched_.has_value(); }
  /// Returns true if `act` may have something to do.
  bool have_work() const { return fetched_ || has_news_; }
  /// Processes all pending requests and returns warnings. All frames before `next_tick` are answered. Throws as the
  /// functions of `host` do, and StateError.
  std::vector<std::string> act(FrameHandler& host, std::uint64_t next_tick);

 private:
  void receive(const wire::ControllerState& message);
  bool is_of_this_lease(const wire::ControllerState& head) const;
  std::vector<std::string> give(const wire::ControllerState& wanted, const FrameHandler& host);
  std::vector<std::string> fetch(FrameHandler& host);
  void send(wire::ControllerState message);

  const std::uint64_t client_;
  const std::function<void()> wake_;
  std::optional<wire::Admit> admit_;
  std::optional<std::uint64_t> saved_tick_;  // tick of `saved_`
  std::vector<std::byte> saved_;
  std::string unsaved_;  // why there is no `saved_`
  bool unsaved_told_ = false;
  std::optional<StateParts> fetched_;  // during a transfer

  std::atomic<bool> has_news_ = false;
  std::mutex mutex_;                        // guards received data that has not been processed
  std::optional<KeptStateMessage> wanted_;  // the last one of each kind
  std::optional<KeptStateMessage> here_;

  std::optional<wire::Writer<wire::ControllerState>> writer_;
  std::optional<wire::Reader<wire::ControllerState>> reader_;
};

}  // namespace cohort
