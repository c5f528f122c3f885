// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "server/serving/attached_client.hpp"
#include "server/serving/client_names.hpp"

namespace cohort::session {

/// The clients that are attached, from one run to the next: joining, leaving, takeover, permissions and messages. For
/// the thread of the run. Functions lock the server's mutex themselves and must be called without it, unless their
/// comment says that they require the lock.
class Clients {
 public:
  /// `mutex`: the server's lock, which must outlive this object.
  explicit Clients(std::mutex& mutex) : mutex_(mutex) {}

  /// Starts a run: clients that drove robots or waited claim their requested robots again, in order of arrival.
  void begin(ServedRun& run);
  /// Ends the run. Requires the lock.
  void end();
  /// Tells all clients that drive robots how the last run ended, with its number. Returns the clients that can receive
  /// it.
  std::set<std::uint64_t> dismiss(const RunResult& last, std::uint32_t run);

  // Handlers of received messages.
  void join(const Inbox::Arrival& arrival);
  void note_liveliness(const Inbox::Liveliness& change);
  void note_process_end(std::uint32_t process);  ///< on this machine
  void note_rejections(const Inbox::Rejected& rejected);
  /// Refuses a client that reports that its controllers fail in `start`: its robots are free again. Returns false if
  /// the client drives no robots, has already answered in its lease, or reports something else.
  bool refuse_unfit(const wire::Report& report);

  /// Decides on claims: at boundaries, and within a tick for a client that takes over a robot that the tick waits for.
  /// If a claim requires that the run goes back, this sets `ServedRun::rewinds_for` to the reason, and the claim is
  /// decided in the next run.
  void decide_claims();
  /// Sends the frames of the current tick.
  void send_frames();
  /// Resends frames that have been unanswered for too long.
  void resend_frames(RunMonitor::Clock::time_point now);
  /// Returns when `resend_frames` is next due for a client that the run waits for, at the latest `latest`. Requires the
  /// lock.
  RunMonitor::Clock::time_point next_resend(RunMonitor::Clock::time_point latest) const;
  // Functions that collect the state of controllers for a snapshot, at a boundary of a run that has started. A client
  // that sends nothing for 5 s, or dies, is left out.
  //
  // Starts the collection.
  void begin_states();
  /// Requests the missing parts. Returns false if no more will arrive.
  bool gather_states(RunMonitor::Clock::time_point now);
  /// Returns the collected states, by robot. Throws SnapshotError if controllers cannot save.
  ControllerStates end_states();
  /// Handles collected parts, and requests for state from clients that continue from a snapshot.
  void take_states(const Inbox::States& states);

  /// Counts an answer of the client as late.
  void note_miss(std::uint64_t client) { ++clients_.at(client).late; }
  /// Tells the client that its policy has ended its lease.
  void tell_detached(std::uint64_t client);

  /// Returns the status of the clients that drive robots. Requires the lock.
  std::vector<wire::ControllerStatus> status();
  std::string label_of(std::uint64_t client) const;
  /// Returns the client whose last Join came from this writer, if any.
  std::optional<std::uint64_t> client_of(const wire::Sender& sender) const {
    return names_.client_of_writer(sender.writer);
  }
  /// Returns true if the sample comes from the process that joined under this id, according to DDS, so that no client
  /// can use another's id. For any thread. Requires the lock.
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const {
    return names_.is_in_own_name(client, sender);
  }

 private:
  AttachedClient* attach(const Inbox::Arrival& arrival);
  void set_alive(AttachedClient& client, bool alive);
  void forget(std::uint64_t client);
  /// `tick`: the run's tick, or that of the frame that the message refers to.
  void tell(AttachedClient& client, wire::ReportKind kind, const std::string& reason, const std::string& text,
            std::optional<std::uint64_t> tick = {});
  enum class Arriving { now, in_a_former_run };
  void claim(AttachedClient& client, Arriving arriving);
  void note_more_selectors(AttachedClient& client, const std::vector<std::string>& before);
  std::set<std::uint32_t> take_matching(std::vector<std::string>& selectors, std::size_t most_mismatches,
                                        std::string& mismatch) const;
  void extend_leases();
  void extend(AttachedClient& client);
  wire::Admit admission(AttachedClient& client, const lockstep::Leases::Lease& lease);
  std::vector<std::uint64_t> frames_under_way(const lockstep::Leases::Lease& lease) const;
  std::string why_forbidden(const AttachedClient& client, const std::set<std::uint32_t>& robots) const;
  void admit(const lockstep::Leases::Granted& granted);
  bool note_lost_state(const AttachedClient& client, const std::vector<std::uint32_t>& robots);
  wire::StartReason why_it_starts(const std::vector<std::uint32_t>& robots, const AttachedClient& client) const;
  bool give_state(AttachedClient& client, std::span<const std::uint32_t> robots);
  void send_frame(AttachedClient& client, std::uint64_t tick, bool resent);
  void resend_frames(AttachedClient& client, std::span<const std::uint64_t> ticks, lockstep::Time now);
  std::string note_unsaved();
  void refuse_state(AttachedClient& client, const std::string& why);

  std::mutex& mutex_;
  ServedRun* run_ = nullptr;  // null between runs
  bool some_want_more_ = false;
  std::uint64_t arrivals_ = 0;
  std::map<std::uint64_t, AttachedClient> clients_;  // by id
  ClientNames names_;                                // guarded by the lock
};

}  // namespace cohort::session
