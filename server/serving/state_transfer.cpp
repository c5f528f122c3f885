// SPDX-License-Identifier: Apache-2.0
#include "server/serving/state_transfer.hpp"

#include <chrono>

namespace cohort::session {
namespace {

// A snapshot omits the state of a client that sends nothing for so long.
constexpr std::chrono::seconds longest_silence{5};

}  // namespace

void StateTransfer::begin(std::size_t robots, Time now) {
  phase_ = Phase::answers;
  parts_.begin(largest_packed(robots), now);
}

void StateTransfer::note_answers() {
  if (phase_ == Phase::answers) phase_ = Phase::parts;
}

void StateTransfer::note_unsaved(const std::string& why) {
  if (!is_under_way()) return;
  phase_ = Phase::unsaved;
  why_unsaved_ = why;
}

bool StateTransfer::is_silent(Time now) const { return now - parts_.heard_at() > longest_silence; }

std::optional<wire::ControllerState> StateTransfer::question(Time now) {
  if (phase_ != Phase::parts || !parts_.is_due(now)) return std::nullopt;
  parts_.note_question(now);
  wire::ControllerState wanted;
  wanted.offset = parts_.offset();
  return wanted;
}

void StateTransfer::take(const KeptStateMessage& part, Time now) {
  if (phase_ != Phase::parts) return;
  parts_.take(part.data, part.head.offset, part.head.size, now);
  if (parts_.is_complete()) phase_ = Phase::done;
}

}  // namespace cohort::session
