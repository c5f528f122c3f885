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

/// A client of a server: who it is, what it asked for, and what it is sent. On the thread of the run.
struct AttachedClient {
  /// `place`: in the order in which clients came.
  AttachedClient(const Inbox::Arrival& arrival, std::uint64_t place);

  wire::Join join;
  std::uint64_t place;
  const std::optional<wire::Identity>& identity;  // of whoever it is, not of whom it says to be
  std::string label;                              // for people: controller, process and host
  wire::Writer<wire::Admit> admit;
  wire::Writer<wire::Observation> observation;
  wire::Writer<wire::Report> report;
  bool alive = true;
  bool is_known = false;  // its Join was read
  bool drove = false;     // in the run before, so that a new one is a reset to it
  // Of this run.
  std::vector<std::uint32_t> robots{};        // that it asked for
  bool claims = false;                        // and was neither granted nor refused
  std::vector<std::uint32_t> drives_first{};  // robots of its lease that nobody drove before it
  lockstep::ResendTimer resend{};
  std::uint32_t times_resent = 0;
  Exchange::Frame frame{};                      // reused: the last one
  std::uint64_t epoch = 0;                      // of the lease that it went to
  std::set<std::string> reported_rejections{};  // reasons that it was told of
  lockstep::AnswerTimes answer_times{};
  std::uint64_t late = 0;  // answers
  std::uint64_t rejected = 0;
  std::uint64_t resent_count = 0;  // frames
  StateTransfer state{};

  std::uint64_t id() const { return join.client; }
  /// Another run begins: nothing is claimed of it yet.
  void begin_run();
  /// What DDS cannot take is lost: trouble with one client is never trouble of the run, which only has an event of it.
  /// `run`: null between runs.
  template <class Message>
  void send(wire::Writer<Message>& writer, const Message& message, ServedRun* run) {
    try {
      writer.write(message);
    } catch (const wire::WireError& error) {
      if (run != nullptr) run->monitor.add_event("unsent", label + ": " + error.what());
    }
  }
  void refuse(ServedRun& run, const std::string& reason);
  /// Its frame of this tick, if it has robots that are due. Under the lock.
  void fill_frame(ServedRun& run, std::uint64_t tick, bool resent);
  void write_frame(ServedRun& run, std::uint64_t tick, bool resent);
  /// Whether it knows of ControllerState.
  bool has_state() const { return join.minor >= wire::first_minor_with_state; }
  /// To it, of its lease's epoch.
  void send_state(wire::ControllerState message, ServedRun& run);
  /// Of one that drives robots, for whoever controls the run. Under the lock.
  wire::ControllerStatus status(ServedRun& run);

 private:
  void note_answers(ServedRun& run);

  wire::Participant& participant_;
  std::optional<wire::Writer<wire::ControllerState>> states_{};  // made when it is needed: writers cost discovery
};

}  // namespace cohort::session
