// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"
#include "server/lockstep/answer_times.hpp"
#include "server/lockstep/resend_timer.hpp"
#include "server/run/exchange.hpp"
#include "server/serving/inbox.hpp"
#include "server/serving/served_run.hpp"
#include "server/serving/state_transfer.hpp"

namespace cohort::session {

/// The reason why a client gets no robots.
struct ClaimRefusal {
  wire::AdmitStatus status = wire::AdmitStatus::refused;
  std::string text{};  ///< sentence for people
};

/// A client of a server: its identity, the robots it asked for, and the messages it is sent. For the thread of the run.
struct AttachedClient {
  /// `place`: position in the order in which clients arrived.
  AttachedClient(const Inbox::Arrival& arrival, std::uint64_t place);

  wire::Join join;
  std::uint64_t place;
  const std::optional<wire::Identity>& identity;  // authenticated by DDS, not claimed by the client
  std::string label;                              // human-readable: controller, process and host
  wire::Writer<wire::Admit> admit;
  wire::Writer<wire::Observation> observation;
  wire::Writer<wire::Report> report;
  bool alive = true;
  bool is_known = false;  // its Join was read
  bool drove = false;     // drove robots in the previous run, so a new run resets it
  // State in this run.
  std::vector<std::uint32_t> robots{};        // requested robots
  bool claims = false;                        // its claim is neither granted nor refused yet
  std::vector<std::string> more{};            // selectors of robots that are to be added to its lease
  std::vector<std::uint32_t> drives_first{};  // robots of its lease that no client drove before
  lockstep::ResendTimer resend{};
  std::uint32_t times_resent = 0;
  Exchange::Frame frame{};                      // the last frame; reused
  std::uint64_t epoch = 0;                      // the epoch of its lease
  std::set<std::string> reported_rejections{};  // reasons that were reported to it
  lockstep::AnswerTimes answer_times{};
  std::uint64_t late = 0;  // late answers
  std::uint64_t rejected = 0;
  std::uint64_t resent_count = 0;  // resent frames
  StateTransfer state{};

  std::uint64_t id() const { return join.client; }
  /// Resets the state for a new run, in which nothing is claimed yet.
  void begin_run();
  /// Sends a message. If DDS cannot send it, the message is lost and an event is added: a problem of one client never
  /// stops the run. `run`: null between runs.
  template <class Message>
  void send(wire::Writer<Message>& writer, const Message& message, ServedRun* run) {
    try {
      writer.write(message);
    } catch (const wire::WireError& error) {
      if (run != nullptr) run->monitor.add_event("unsent", label + ": " + error.what());
    }
  }
  void refuse(ServedRun& run, const ClaimRefusal& refusal);
  /// Fills in the client's frame of this tick, if any of its robots is due. Requires the lock.
  void fill_frame(ServedRun& run, std::uint64_t tick, bool resent);
  void write_frame(ServedRun& run, std::uint64_t tick, bool resent);
  /// Returns true if the client supports ControllerState.
  bool has_state() const { return join.minor >= wire::first_minor_with_state; }
  /// Returns true if the client supports a lease that gets more robots.
  bool has_growing_lease() const { return join.minor >= wire::first_minor_with_growing_leases; }
  /// Sends a message to the client, with the epoch of its lease.
  void send_state(wire::ControllerState message, ServedRun& run);
  /// Returns the status of a client that drives robots, for clients that control the run. Requires the lock.
  wire::ControllerStatus status(ServedRun& run);

 private:
  void note_answers(ServedRun& run);

  wire::Participant& participant_;
  std::optional<wire::Writer<wire::ControllerState>> states_{};  // created on first use, as writers cost discovery
};

}  // namespace cohort::session
