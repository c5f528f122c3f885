// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/wire/control_messages.hpp"
#include "server/run/playback.hpp"
#include "server/run/run_monitor.hpp"
#include "server/serving/control/control_queries.hpp"
#include "server/serving/control/controlled_run.hpp"
#include "server/serving/control/kept_snapshots.hpp"
#include "server/serving/control/live_recordings.hpp"
#include "server/serving/control/model_texts.hpp"
#include "server/serving/control/requests/received_request.hpp"
#include "server/serving/control/requests/request_budget.hpp"
#include "server/serving/control/requests/request_ledger.hpp"
#include "server/serving/control/requests/requester_slots.hpp"
#include "server/serving/control/time_holders.hpp"

namespace cohort::session {

/// Control of a session over DDS; the server's side of docs/protocol.md, "Control". Queries are answered at once;
/// operations that change something wait for a boundary and are carried out in order of arrival. For the thread of the
/// run.
class Control {
 public:
  using Clock = RunMonitor::Clock;

  /// `recordings` must outlive this object. `wake` is called from any thread when there may be work.
  Control(LiveRecordings& recordings, std::function<void()> wake) : recordings_(recordings), texts_(std::move(wake)) {}

  void begin(ControlledRun run);
  /// Ends the run, and rejects the requests that still wait, except those that the next run can answer.
  void end(RunResult::End how);

  void take(const ReceivedRequest& received);
  /// Notes that the writer of a client's requests has disappeared.
  void lose(const wire::Sender& sender);

  /// Notes that the run has reached a boundary, where requested steps may be complete.
  void reach_boundary();
  enum class Moment { boundary, midst };
  /// Carries out waiting requests. Within a tick these are only requests that end the run, after which nothing else has
  /// an effect. Returns false if the run has to end; see `ending`.
  bool perform(Moment moment);
  struct Ending {
    RunResult::End how = RunResult::End::shut_down;
    std::optional<NextRun> next{};
  };
  const std::optional<Ending>& ending() const { return ending_; }
  /// Returns true if the run can go back to a tick at which the state of all controllers was saved.
  bool can_rewind() const { return run_->monitor.options().prepare && last_whole_snapshot() != nullptr; }
  /// Ends the run in order to go back; see `ending`. `why` becomes an event of the next run. May be called at any
  /// moment of a tick.
  void rewind(const std::string& why);
  /// Returns true if the run stays at this boundary.
  bool holds() const { return playback_.holds(); }
  /// Answers the clients that requested the time of this tick, after its frames were sent.
  void grant_time();
  /// Returns true if a client holds the run's time at this tick.
  bool holds_time() const { return time_holders_.awaited(run_->simulation.tick()).has_value(); }
  /// Returns the label of that client.
  std::string time_holder() const;
  /// Returns true if a waiting request may be carried out now.
  bool has_work();

 private:
  struct Requester {
    std::string label;    // human-readable
    std::string account;  // account that its requests are charged to
    std::uint64_t writer = 0;
    std::uint32_t minor = 0;  // minor version of the protocol
    wire::Writer<wire::Reply> replies;
  };
  // Returns a reply to the request, without a result yet.
  static wire::Reply reply_to(const wire::Request& request);
  Requester* requester_of(const ReceivedRequest& received);
  void receive(const wire::Request& request);
  void put_off(const wire::Request& request);
  void lose(std::uint64_t client);
  void send(wire::Reply reply, bool is_kept);
  void answer(const wire::Request& request, wire::ResultCode result, const std::string& text);
  void answer_steps(const std::vector<Playback::Steps>& steps, wire::ResultCode result, const std::string& text);
  void tell(const wire::Request& request, const std::string& text, std::vector<std::byte> action = {});
  std::string label_of(std::uint64_t client) const;
  // Limits of the share of the run's time that requests may take.
  const std::string& account_of(std::uint64_t client) const;
  bool is_unlimited() const;
  bool may_be_done(const wire::Request& request);
  void charge(const wire::Request& request, RequestBudget::Time took);
  void read_texts();
  const wire::Request* next_to_read();
  std::vector<wire::Request> take_next(Moment moment);
  void drop_what_is_too_much();

  // Operations: each is completed or refused with a reply, or started.
  void answer_query(const wire::Request& request);
  void do_one(const wire::Request& request);
  void carry_out(const wire::Request& request, const wire::SetSimulationState& operation);
  void carry_out(const wire::Request& request, const wire::StepSimulation& operation);
  void carry_out(const wire::Request& request, const wire::ResetSimulation& operation);
  void carry_out(const wire::Request& request, const wire::SetSpeed& operation);
  void advance_time(const wire::Request& request, const wire::AdvanceTime& operation);
  void release_time(std::uint64_t client, const std::string& why);
  void carry_out(const wire::Request& request, const wire::SaveSnapshot&);
  void carry_out(const wire::Request& request, const wire::LoadSnapshot&);
  void carry_out(const wire::Request& request, const wire::GoBack& operation);
  void carry_out(const wire::Request& request, const wire::StartRecording& operation);
  void quit(const wire::Request& request);
  // Start of another run, and snapshots of this one.
  void begin_anew(const wire::Request& request, NextRun next, const std::string& text);
  void keep_snapshot();
  std::shared_ptr<const SessionSnapshot> last_whole_snapshot() const;
  NextRun run_from(std::shared_ptr<const SessionSnapshot> snapshot) const;
  void go_on_from(const wire::Request& request, std::shared_ptr<const SessionSnapshot> snapshot);
  void do_actions(std::span<const wire::Request> requests);

  LiveRecordings& recordings_;
  std::optional<ControlledRun> run_;
  Playback playback_;
  TimeHolders time_holders_;
  std::optional<Ending> ending_;
  std::vector<wire::Request> answered_by_next_run_;
  // The snapshot of this boundary. It costs each controller a round trip, so clients that request it at the same
  // boundary share it.
  struct Saved {
    std::string text;
    std::shared_ptr<const std::vector<std::byte>> bytes;
  };
  std::optional<Saved> saved_;
  KeptSnapshots kept_{0, 0};
  bool goes_back_ = false;  // the next run starts from an earlier tick of this one
  RequestLedger ledger_;
  RequestBudget budget_;
  ModelTexts texts_;
  std::uint64_t last_read_for_ = 0;  // client whose text was read last
  std::uint64_t first_tick_ = 0;     // the first tick of this run
  RequesterSlots slots_;
  std::map<std::uint64_t, Requester> requesters_;            // by client
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;  // by the writer of the requests
  ControlQueries queries_{ledger_, recordings_, kept_};
};

}  // namespace cohort::session
