// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_state.hpp"
#include "client_sdk/hosting/state_parts.hpp"
#include "idl/dds/transport.hpp"

namespace cohort::session {

/// The state of one client's controllers, on its way into a snapshot or from a snapshot: docs/protocol.md, "State of
/// controllers". For the thread of the run.
class StateTransfer {
 public:
  using Time = StateParts::Time;

  enum class Phase {
    idle,     ///< nothing is requested
    answers,  ///< waiting for its answers to unanswered frames
    parts,    ///< requesting parts
    done,
    given_up,
    unsaved,  ///< its controllers cannot save
  };
  Phase phase() const { return phase_; }
  bool is_under_way() const { return phase_ == Phase::answers || phase_ == Phase::parts; }

  /// Starts the transfer of the state of at most `robots` robots, at a boundary.
  void begin(std::size_t robots, Time now);
  void note_answers();  ///< to be called when no unanswered frames are left
  void give_up() { phase_ = Phase::given_up; }
  /// Notes why its controllers cannot save.
  void note_unsaved(const std::string& why);
  const std::string& why_unsaved() const { return why_unsaved_; }
  void end() { phase_ = Phase::idle; }
  /// Returns true if the client has sent nothing for too long.
  bool is_silent(Time now) const;
  /// Returns the request that is due now, if any; the caller fills in the other members.
  std::optional<wire::ControllerState> question(Time now);
  /// Takes a part; throws StateError.
  void take(const KeptStateMessage& part, Time now);
  std::span<const std::byte> bytes() const { return parts_.bytes(); }

  /// The state that the client can fetch; empty if there is none.
  std::vector<std::byte> to_load{};

 private:
  Phase phase_ = Phase::idle;
  StateParts parts_;
  std::string why_unsaved_;
};

}  // namespace cohort::session
