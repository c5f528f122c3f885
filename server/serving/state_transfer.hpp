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

/// What one client's controllers remember, on its way from it into a snapshot and from a snapshot to it:
/// docs/protocol.md, "State of controllers". On the thread of the run.
class StateTransfer {
 public:
  using Time = StateParts::Time;

  enum class Phase {
    idle,     ///< nothing is wanted of it
    answers,  ///< its answers to frames under way are awaited
    parts,    ///< it is asked for parts
    done,
    given_up,
    unsaved,  ///< its controllers cannot save
  };
  Phase phase() const { return phase_; }
  bool is_under_way() const { return phase_ == Phase::answers || phase_ == Phase::parts; }

  /// A boundary: what it remembers is wanted, of at most so many robots.
  void begin(std::size_t robots, Time now);
  void note_answers();  ///< there are no frames without an answer any more
  void give_up() { phase_ = Phase::given_up; }
  /// Its controllers cannot save, for this reason.
  void note_unsaved(const std::string& why);
  const std::string& why_unsaved() const { return why_unsaved_; }
  void end() { phase_ = Phase::idle; }
  /// Whether it has given nothing for too long.
  bool is_silent(Time now) const;
  /// The question that has to be asked now, if one has to be; its head is up to the caller.
  std::optional<wire::ControllerState> question(Time now);
  /// Throws StateError.
  void take(const KeptStateMessage& part, Time now);
  std::span<const std::byte> bytes() const { return parts_.bytes(); }

  /// What it can fetch; nothing if there is none.
  std::vector<std::byte> to_load{};

 private:
  Phase phase_ = Phase::idle;
  StateParts parts_;
  std::string why_unsaved_;
};

}  // namespace cohort::session
