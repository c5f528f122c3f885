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

namespace cohort::session {

/// Control of a session over DDS: docs/protocol.md, "Control", the server's side. Questions are answered at once; what
/// changes something waits for a boundary, and is done in the order of arrival. All on the thread of the run.
class Control {
 public:
  using Clock = RunMonitor::Clock;

  /// `recordings` must outlive this. `wake` is called from any thread when there may be work.
  Control(LiveRecordings& recordings, std::function<void()> wake) : recordings_(recordings), texts_(std::move(wake)) {}

  void begin(ControlledRun run);
  /// Tells those who wait for something that it will not come, unless the next run brings it.
  void end(RunResult::End how);

  void take(const ReceivedRequest& received);
  /// The writer of somebody's requests has gone.
  void lose(const wire::Sender& sender);

  /// The run has come to a boundary: steps may be done.
  void reach_boundary();
  /// Does what waits. In the midst of a tick that is only what ends the run: nothing that it does comes to anything any
  /// more. False if the run has to end, as `ending` says.
  enum class Moment { boundary, midst };
  bool perform(Moment moment);
  struct Ending {
    RunResult::End how = RunResult::End::shut_down;
    std::optional<NextRun> next{};
  };
  const std::optional<Ending>& ending() const { return ending_; }
  /// Whether the run can go back to where the state of all controllers is known.
  bool can_rewind() const { return run_->monitor.options().prepare && last_whole_snapshot() != nullptr; }
  /// Ends the run for that, as `ending` says; `why` becomes an event of the next one. Any moment of a tick.
  void rewind(const std::string& why);
  /// Whether the run stays at this boundary.
  bool holds() const { return playback_.holds(); }
  /// Whether anything that waits may be done now.
  bool has_work();

 private:
  struct Requester {
    std::string label;    // for people
    std::string account;  // that what it asks for is charged to
    std::uint64_t writer = 0;
    wire::Writer<wire::Reply> replies;
  };
  // A reply to a request, not filled in yet.
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
  // Requests may take a part of the run's time only.
  const std::string& account_of(std::uint64_t client) const;
  bool is_unlimited() const;
  bool may_be_done(const wire::Request& request);
  void charge(const wire::Request& request, RequestBudget::Time took);
  void read_texts();
  const wire::Request* next_to_read();
  std::vector<wire::Request> take_next(Moment moment);
  void drop_what_is_too_much();

  // Operations: done or refused with a reply, or begun.
  void answer_query(const wire::Request& request);
  void do_one(const wire::Request& request);
  void carry_out(const wire::Request& request, const wire::SetSimulationState& operation);
  void carry_out(const wire::Request& request, const wire::StepSimulation& operation);
  void carry_out(const wire::Request& request, const wire::ResetSimulation& operation);
  void carry_out(const wire::Request& request, const wire::SetSpeed& operation);
  void carry_out(const wire::Request& request, const wire::SaveSnapshot&);
  void carry_out(const wire::Request& request, const wire::LoadSnapshot&);
  void carry_out(const wire::Request& request, const wire::GoBack& operation);
  void carry_out(const wire::Request& request, const wire::StartRecording& operation);
  void quit(const wire::Request& request);
  // What begins a run anew, and what is kept of one.
  void begin_anew(const wire::Request& request, NextRun next, const std::string& text);
  void keep_snapshot();
  std::shared_ptr<const SessionSnapshot> last_whole_snapshot() const;
  NextRun run_from(std::shared_ptr<const SessionSnapshot> snapshot) const;
  void go_on_from(const wire::Request& request, std::shared_ptr<const SessionSnapshot> snapshot);
  void do_actions(std::span<const wire::Request> requests);

  LiveRecordings& recordings_;
  std::optional<ControlledRun> run_;
  Playback playback_;
  std::optional<Ending> ending_;
  std::vector<wire::Request> answered_by_next_run_;
  // The snapshot of this boundary: it costs every controller a round trip, so those who ask for it together share it.
  struct Saved {
    std::string text;
    std::shared_ptr<const std::vector<std::byte>> bytes;
  };
  std::optional<Saved> saved_;
  KeptSnapshots kept_{0, 0};
  bool goes_back_ = false;  // the next run is this one's past
  RequestLedger ledger_;
  RequestBudget budget_;
  ModelTexts texts_;
  std::uint64_t last_read_for_ = 0;  // a client
  std::uint64_t first_tick_ = 0;     // of this run
  RequesterSlots slots_;
  std::map<std::uint64_t, Requester> requesters_;            // by client
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;  // of requests
  ControlQueries queries_{ledger_, recordings_, kept_};
};

}  // namespace cohort::session
