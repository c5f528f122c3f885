// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/client_states.hpp"

#include <chrono>
#include <span>
#include <utility>

#include "client_sdk/src/network_clock.hpp"

namespace cohort {
namespace {

constexpr int state_messages_kept = 4;

StateParts::Time now_for_parts() { return NetworkClock::now().time_since_epoch(); }

}  // namespace

ClientStates::ClientStates(wire::Participant& participant, std::uint64_t client, std::function<void()> wake)
    : client_(client), wake_(std::move(wake)) {
  try {
    reader_.emplace(participant,
                    wire::Reader<wire::ControllerState>::Callbacks{
                        [this](const wire::ControllerState& message, const wire::Sender&) { receive(message); }, {}},
                    wire::partition_of(client), state_messages_kept);
    writer_.emplace(participant);
  } catch (const wire::WireError&) {
    if (!participant.identity()) throw;
    reader_.reset();
  }
}

void ClientStates::receive(const wire::ControllerState& message) {
  if (message.client != client_ || message.data.size() > wire::largest_state_part) return;
  {
    const std::lock_guard lock(mutex_);
    switch (message.kind) {
      case wire::StateKind::wanted: wanted_.emplace(message); break;
      case wire::StateKind::here: here_.emplace(message); break;
      default: return;  // from a later minor version
    }
    has_news_ = true;
  }
  wake_();
}

void ClientStates::begin(const wire::Admit& admit) {
  admit_ = admit;
  saved_tick_.reset();
  fetched_.reset();
  if (admit.start_reason == wire::StartReason::restored_with_state)
    fetched_.emplace().begin(largest_packed(admit.robots.size()), now_for_parts());
}

bool ClientStates::is_of_this_lease(const wire::ControllerState& head) const {
  return admit_ && head.run == admit_->run && head.epoch == admit_->epoch;
}

std::vector<std::string> ClientStates::act(FrameHandler& host, std::uint64_t next_tick) {
  has_news_ = false;
  if (!writer_ || !admit_) return {};
  if (fetched_) return fetch(host);
  std::optional<KeptStateMessage> wanted;
  {
    const std::lock_guard lock(mutex_);
    wanted = std::exchange(wanted_, std::nullopt);
  }
  // If a later frame has been answered, the request is outdated.
  if (wanted && is_of_this_lease(wanted->head) && next_tick <= wanted->head.tick) return give(wanted->head, host);
  return {};
}

std::vector<std::string> ClientStates::give(const wire::ControllerState& wanted, const FrameHandler& host) {
  if (saved_tick_ != wanted.tick) {
    unsaved_.clear();
    try {
      saved_ = pack(host.save());
    } catch (const SaveFailure& failure) {
      unsaved_ = failure.what();
    }
  }
  saved_tick_ = wanted.tick;
  wire::ControllerState part =
      unsaved_.empty() ? part_of(saved_, wanted.offset) : part_of(std::as_bytes(std::span(unsaved_)), 0);
  if (!unsaved_.empty()) part.kind = wire::StateKind::unsaved;
  part.tick = wanted.tick;
  send(part);
  if (unsaved_.empty() || std::exchange(unsaved_told_, true)) return {};
  return {unsaved_ + "; no snapshot was taken (logged once)"};
}

std::vector<std::string> ClientStates::fetch(FrameHandler& host) {
  std::optional<KeptStateMessage> here;
  {
    const std::lock_guard lock(mutex_);
    here = std::exchange(here_, std::nullopt);
  }
  if (here && is_of_this_lease(here->head))
    fetched_->take(here->data, here->head.offset, here->head.size, now_for_parts());
  if (fetched_->is_complete()) {
    const std::vector<RobotState> states = unpack(fetched_->bytes());
    fetched_.reset();
    return host.load(states);
  }
  if (const auto now = now_for_parts(); fetched_->is_due(now)) {
    wire::ControllerState wanted;
    wanted.tick = admit_->tick;
    wanted.offset = fetched_->offset();
    send(wanted);
    fetched_->note_question(now);
  }
  return {};
}

void ClientStates::send(wire::ControllerState message) {
  message.client = client_;
  message.run = admit_->run;
  message.epoch = admit_->epoch;
  writer_->write(message);  // lost: requested again
}

}  // namespace cohort
