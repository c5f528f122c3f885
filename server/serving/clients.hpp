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

/// Who is attached, from one run to the next: joining, leaving, taking over, who may drive what, and what each client
/// is told. On the thread of the run; functions take the server's lock themselves, and must not be called with it, but
/// for those that say that they are called under it.
class Clients {
 public:
  /// `mutex`: the server's lock, which must outlive this.
  explicit Clients(std::mutex& mutex) : mutex_(mutex) {}

  /// A run begins: those who drove or waited claim what they asked for when they came, in the order of their coming.
  void begin(ServedRun& run);
  /// It ends. Under the lock.
  void end();
  /// There will be no further run after the one of this number: tells all who drive how it ended. Those of them who can
  /// hear it.
  std::set<std::uint64_t> dismiss(const RunResult& last, std::uint32_t run);

  // What came in.
  void join(const Inbox::Arrival& arrival);
  void note_liveliness(const Inbox::Liveliness& change);
  void note_process_end(std::uint32_t process);  ///< of this machine
  void note_rejections(const Inbox::Rejected& rejected);
  /// Refuses a client that reports that its controllers fail in `start`: its robots are free as before it came. False
  /// if it drives none, has answered in its lease, or reports something else.
  bool refuse_unfit(const wire::Report& report);

  /// Claims are granted at boundaries, and in the midst of a tick to whoever takes over a robot that it waits for.
  /// If a claim calls for the run to go back, `ServedRun::rewinds_for` says why, and it counts again in the next run.
  void decide_claims();
  /// The frames of the current tick.
  void send_frames();
  /// Those that are unanswered for long.
  void resend_frames(RunMonitor::Clock::time_point now);
  /// When `resend_frames` is due for somebody who is awaited, at the latest `latest`. Under the lock.
  RunMonitor::Clock::time_point next_resend(RunMonitor::Clock::time_point latest) const;
  // At a boundary of a run that has started: what controllers remember, for a snapshot. Whoever gives nothing for 5 s,
  // or dies, is left out.
  /// Begins to gather it.
  void begin_states();
  /// Asks for what is missing; false if nothing more will come.
  bool gather_states(RunMonitor::Clock::time_point now);
  /// What came of it, by robot. Throws SnapshotError if controllers cannot save.
  ControllerStates end_states();
  /// Parts that were gathered, and questions of those who go on from a snapshot.
  void take_states(const Inbox::States& states);

  /// An answer of the client has missed its deadline.
  void note_miss(std::uint64_t client) { ++clients_.at(client).late; }
  /// Its policy has ended the client's lease.
  void tell_detached(std::uint64_t client);

  /// Of those who drive. Under the lock.
  std::vector<wire::ControllerStatus> status();
  std::string label_of(std::uint64_t client) const;
  /// Whose last Join came from this writer, if anybody's.
  std::optional<std::uint64_t> client_of(const wire::Sender& sender) const {
    return names_.client_of_writer(sender.writer);
  }
  /// Whether DDS says that this comes from the process that joined under that id, so that nobody can speak in another's
  /// name. Any thread, under the lock.
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const {
    return names_.is_in_own_name(client, sender);
  }

 private:
  AttachedClient* attach(const Inbox::Arrival& arrival);
  void set_alive(AttachedClient& client, bool alive);
  void forget(std::uint64_t client);
  /// `tick`: the run's, unless it is about a frame.
  void tell(AttachedClient& client, wire::ReportKind kind, const std::string& reason, const std::string& text,
            std::optional<std::uint64_t> tick = {});
  void claim(AttachedClient& client);
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
  std::uint64_t arrivals_ = 0;
  std::map<std::uint64_t, AttachedClient> clients_;  // by id
  ClientNames names_;                                // under the lock
};

}  // namespace cohort::session
