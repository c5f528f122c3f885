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

/// A client's part of what docs/protocol.md says of "State of controllers": gives what its controllers remember to a
/// server that wants it, and fetches what a snapshot has of them. On the thread that uses the controllers.
class ClientStates {
 public:
  /// `wake` is called on threads of DDS when there is something to do.
  ClientStates(wire::Participant& participant, std::uint64_t client, std::function<void()> wake);

  /// False where an identity was made without the right to it: then the client does without.
  bool are_possible() const { return writer_.has_value(); }

  /// A lease has begun, and its controllers are started.
  void begin(const wire::Admit& admit);
  /// Whether frames have to wait until the controllers have their state.
  bool are_awaited() const { return fetched_.has_value(); }
  /// Whether `act` may have something to do.
  bool have_work() const { return fetched_ || has_news_; }
  /// Does what there is to do. `next_tick`: all frames before it are answered. Sentences for people. Throws as the
  /// host's functions do, and StateError.
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
  std::optional<std::uint64_t> saved_tick_;  // of `saved_`
  std::vector<std::byte> saved_;
  std::string unsaved_;  // why there is no `saved_`
  bool unsaved_told_ = false;
  std::optional<StateParts> fetched_;  // while it is

  std::atomic<bool> has_news_ = false;
  std::mutex mutex_;                        // guards what came and was not looked at
  std::optional<KeptStateMessage> wanted_;  // the last of each kind
  std::optional<KeptStateMessage> here_;

  std::optional<wire::Writer<wire::ControllerState>> writer_;
  std::optional<wire::Reader<wire::ControllerState>> reader_;
};

}  // namespace cohort
