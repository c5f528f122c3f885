// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/control.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "idl/text/printable.hpp"
#include "server/serving/control/control_actions.hpp"
#include "server/serving/control/control_texts.hpp"
#include "server/serving/control/requests/request_checks.hpp"

namespace cohort::session {
namespace {

using wire::OperationCode;
using wire::Reply;
using wire::Request;
using wire::ResultCode;
using wire::SimulationState;

constexpr std::size_t most_waiting_bytes = std::size_t{64} << 20;
constexpr std::size_t most_waiting_of_account = 64;
constexpr std::size_t most_kept_bytes = std::size_t{256} << 20;        // for snapshots that a run can go back to
constexpr std::size_t most_kept_for_clients = std::size_t{256} << 20;  // for snapshots, uploads and recordings
constexpr std::size_t longest_message = 4096;
constexpr std::chrono::milliseconds last_reply{500};

RequestBudget::Time now() { return Control::Clock::now().time_since_epoch(); }

SimulationState on_wire(PlaybackState state) {
  switch (state) {
    case PlaybackState::stopped: return SimulationState::stopped;
    case PlaybackState::playing: return SimulationState::playing;
    case PlaybackState::paused: break;
  }
  return SimulationState::paused;
}

bool may_ask(const wire::Identity& identity, OperationCode operation) {
  return identity.may_control ||
         (identity.participant == wire::observers_participant && wire::is_looking_on(operation));
}

bool is_query(const Request& request) { return wire::is_query(request.code()); }

bool ends_the_run(const Request& request) {
  if (const auto* set = std::get_if<wire::SetSimulationState>(&request.operation))
    return set->state == SimulationState::stopped || set->state == SimulationState::quitting;
  const OperationCode code = request.code();
  return code == OperationCode::reset_simulation || code == OperationCode::load_snapshot ||
         code == OperationCode::go_back;
}

// Returns true for requests that take no time; a client must always be able to stop the run.
bool takes_no_time(const Request& request) {
  if (const auto* set = std::get_if<wire::SetSimulationState>(&request.operation))
    return set->state != SimulationState::stopped;
  const OperationCode code = request.code();
  return code == OperationCode::step_simulation || code == OperationCode::set_speed ||
         code == OperationCode::stop_recording;
}

}  // namespace

void Control::begin(ControlledRun run) {
  run_.emplace(std::move(run));
  first_tick_ = run_->simulation.tick();
  ending_.reset();
  playback_ = Playback(run_->monitor.options().state);
  time_holders_.begin_run();
  queries_.begin(*run_);
  texts_.begin(run_->experiment.read_model);
  const auto& from = run_->monitor.options().from;
  if (!std::exchange(goes_back_, false)) {
    kept_ =
        KeptSnapshots(static_cast<std::uint64_t>(run_->monitor.options().keep_interval / run_->experiment.world.step),
                      most_kept_bytes);
    if (from && kept_.interval() > 0) kept_.keep(from);  // the beginning of this run
  }
  for (const Request& request : std::exchange(answered_by_next_run_, {}))
    answer(request, ResultCode::ok,
           "run " + std::to_string(run_->number) + " is at tick " + std::to_string(run_->simulation.tick()) +
               ", seed " + std::to_string(run_->experiment.seed) +
               (from ? left_out_text(*from, run_->experiment) : std::string()));
}

void Control::end(RunResult::End how) {
  const std::string at = "the run ended at tick " + std::to_string(run_->simulation.tick());
  answer_steps(playback_.set(PlaybackState::playing), ResultCode::cancelled, at);
  for (const Request& request : std::exchange(ledger_.waiting(), {}))
    if (!is_query(request)) answer(request, ResultCode::incorrect_state, at);  // queries are repeated by their clients
  const bool goes_on = how == RunResult::End::reset || how == RunResult::End::restored;
  if (!goes_on)
    for (const TimeHolders::Grant& each : time_holders_.take_requests())
      answer({.client = each.client, .number = each.number, .operation = wire::AdvanceTime{}},
             ResultCode::incorrect_state, at);
  if (!goes_on)  // the server may be gone soon
    for (auto& [id, requester] : requesters_) requester.replies.wait_until_received(last_reply);
  run_.reset();
}

wire::Reply Control::reply_to(const Request& request) {
  Reply reply;
  reply.client = request.client;
  reply.number = request.number;
  reply.operation = request.code();
  return reply;
}

Control::Requester* Control::requester_of(const ReceivedRequest& received) {
  const std::uint64_t client = received.request.client;
  const auto& identity = received.participant->identity();
  const auto admission =
      slots_.use(client, identity ? identity->name : std::string(), !identity || identity->may_control, now());
  if (admission.leaves) lose(*admission.leaves);
  if (!admission.is_in) return nullptr;
  client_of_writer_[received.sender.writer] = client;
  if (const auto known = requesters_.find(client); known != requesters_.end()) {
    known->second.writer = received.sender.writer;
    return &known->second;
  }
  return &requesters_
              .emplace(client,
                       Requester{
                           .label = received.request.label + (identity ? " ('" + identity->name + "')" : std::string()),
                           .account = identity ? identity->name : wire::partition_of(client),
                           .writer = received.sender.writer,
                           .minor = received.request.minor,
                           .replies = wire::Writer<Reply>(*received.participant, wire::partition_of(client))})
              .first->second;
}

void Control::take(const ReceivedRequest& received) {
  const Request& request = received.request;
  const auto reject = [&](const std::string& text) { run_->monitor.add_event("rejected", text); };
  if (request.client == 0 || !ledger_.is_in_own_name(request.client, received.sender.participant))
    return reject("foreign: a Request has the id of another client, or id 0");
  if (requester_of(received) == nullptr)
    return reject("flood: too many clients control this run, and none of them is idle");
  if (const auto& identity = received.participant->identity(); identity && !may_ask(*identity, request.code())) {
    reject("forbidden: " + label_of(request.client) + " may not control the run");
    Reply reply = reply_to(request);
    reply.result = ResultCode::not_permitted;
    reply.error_message = "the identity '" + identity->name +
                          "' may not control the run; 'cohort security' grants this right as 'control'";
    return send(std::move(reply), false);
  }
  const RequestBudget::Time began = now();
  receive(request);
  charge(request, now() - began);
}

void Control::receive(const Request& request) {
  const auto refuse = [&](ResultCode result, const std::string& text) {
    Reply reply = reply_to(request);
    reply.result = result;
    reply.error_message = text;
    send(std::move(reply), false);
  };
  if (request.number == 0) return refuse(ResultCode::malformed, "request numbers start at 1");
  if (const std::string wrong = what_is_wrong(request); !wrong.empty())
    return refuse(wire::name_of(request.code()).empty() ? ResultCode::feature_unsupported : ResultCode::malformed,
                  wrong);
  if (is_query(request)) return may_be_done(request) ? answer_query(request) : put_off(request);
  switch (ledger_.receive(request.client, request.number)) {
    case RequestLedger::Receipt::under_way: return;  // a reply will follow
    case RequestLedger::Receipt::answered: return send(ledger_.remembered(request.client, request.number), false);
    case RequestLedger::Receipt::forgotten:
      return refuse(ResultCode::forgotten,
                    "request " + std::to_string(request.number) + " is too old: request numbers must increase");
    case RequestLedger::Receipt::too_many:
      return refuse(ResultCode::too_many_requests, "more than " + std::to_string(wire::requests_under_way) +
                                                       " requests of this client are already waiting");
    case RequestLedger::Receipt::fresh: break;
  }
  if (const auto* const advance = std::get_if<wire::AdvanceTime>(&request.operation))
    return advance_time(request, *advance);  // does not change the world
  put_off(request);
}

// Postpones a request until a boundary, and until its account's turn. A dropped query is repeated by its client.
void Control::put_off(const Request& request) {
  std::size_t bytes = size_of(request);
  std::size_t of_account = 0;
  for (const Request& waiting : ledger_.waiting()) {
    if (waiting.client == request.client && waiting.number == request.number) return;
    bytes += size_of(waiting);
    if (account_of(waiting.client) == account_of(request.client)) ++of_account;
  }
  const bool is_question = is_query(request);
  if (of_account >= most_waiting_of_account || bytes > most_waiting_bytes) {
    run_->monitor.add_event("rejected", "flood: too many requests of " + label_of(request.client));
    if (is_question) return;
    return answer(request, ResultCode::too_many_requests,
                  "too many requests: " + std::to_string(of_account) + " of " + account_of(request.client) +
                      " are already waiting");
  }
  ledger_.waiting().push_back(request);
}

void Control::lose(const wire::Sender& sender) {
  const auto found = client_of_writer_.find(sender.writer);
  if (found == client_of_writer_.end()) return;
  const std::uint64_t client = found->second;
  client_of_writer_.erase(found);
  const auto requester = requesters_.find(client);
  // A client that was lost and found again has a new writer, and the end of the old one is reported late.
  if (requester == requesters_.end() || requester->second.writer != sender.writer) return;
  lose(client);
}

void Control::lose(std::uint64_t client) {
  release_time(client, "has disconnected");
  requesters_.erase(client);
  slots_.leave(client);
  ledger_.leave(client);
  recordings_.leave(client);
}

void Control::send(Reply reply, bool is_kept) {
  if (run_) {
    reply.state =
        ending_ && ending_->how == RunResult::End::shut_down ? SimulationState::quitting : on_wire(playback_.state());
    reply.run = run_->number;
    reply.tick = run_->simulation.tick();
    reply.time_ns = run_->simulation.time().count();
  }
  reply.error_message = printable(reply.error_message, longest_message, Lines::kept);
  if (is_kept) ledger_.keep(reply);
  const auto requester = requesters_.find(reply.client);
  if (requester == requesters_.end()) return;
  reply.result = wire::known_to(requester->second.minor, reply.result);
  requester->second.replies.write(reply);  // if the reply is lost, the client asks again
}

void Control::answer(const Request& request, ResultCode result, const std::string& text) {
  Reply reply = reply_to(request);
  reply.result = result;
  reply.error_message = text;
  send(std::move(reply), true);
}

void Control::answer_steps(const std::vector<Playback::Steps>& steps, ResultCode result, const std::string& text) {
  for (const Playback::Steps& each : steps) {
    const Request request{.client = each.client, .number = each.number, .operation = wire::StepSimulation{}};
    const std::uint64_t tick = run_->simulation.tick();
    answer(request, result, each.until > tick ? text + ", with " + ticks_text(each.until - tick) + " left" : text);
  }
}

std::string Control::label_of(std::uint64_t client) const {
  const auto found = requesters_.find(client);
  return found == requesters_.end() ? "a disconnected client" : found->second.label;
}

void Control::tell(const Request& request, const std::string& text, std::vector<std::byte> action) {
  run_->monitor.controlled({run_->simulation.tick(), wire::name_of(request.code()),
                            text + ", requested by " + label_of(request.client), std::move(action)});
}

void Control::reach_boundary() {
  budget_.note_boundary(run_->simulation.tick() != first_tick_, now());
  queries_.note_progress(Clock::now());
  if (kept_.wants(run_->simulation.tick())) keep_snapshot();
  if (!playback_.has_steps()) return;
  const auto done = playback_.reached(run_->simulation.tick());
  answer_steps(done, ResultCode::ok, "paused at tick " + std::to_string(run_->simulation.tick()));
}

void Control::keep_snapshot() {
  try {
    kept_.keep(run_->take_snapshot());
  } catch (const SnapshotError&) {
    // Either a controller failed, which ends the run, or one cannot save, which is noted as an event.
  }
}

const std::string& Control::account_of(std::uint64_t client) const {
  static const std::string gone = "disconnected clients";
  const auto found = requesters_.find(client);
  return found == requesters_.end() ? gone : found->second.account;
}

// Requests need no limit in a run that is paused or over.
bool Control::is_unlimited() const { return playback_.holds() || run_->monitor.is_over(); }

bool Control::may_be_done(const Request& request) {
  if (text_of_model(request) != nullptr && texts_.find(key_of(request)) == nullptr) return false;
  if (takes_no_time(request) || is_unlimited()) return true;
  if (request.code() == OperationCode::save_snapshot && saved_) return true;
  const std::string& account = account_of(request.client);
  return ends_the_run(request) ? budget_.allows_restart(account, now()) : budget_.allows(account, now());
}

void Control::charge(const Request& request, RequestBudget::Time took) {
  if (!is_unlimited()) budget_.charge(account_of(request.client), took, now());
}

// Reads the waiting texts of models, one per client in turn.
void Control::read_texts() {
  if (const auto read = texts_.collect(); read && !is_unlimited())
    budget_.charge(account_of(read->first), texts_.find(*read)->took, now());
  while (texts_.is_free()) {
    const Request* const next = next_to_read();
    if (next == nullptr) return;
    last_read_for_ = next->client;
    texts_.take(key_of(*next), *text_of_model(*next));
  }
}

const Request* Control::next_to_read() {
  std::map<std::uint64_t, const Request*> first_of;  // by client
  for (const Request& request : ledger_.waiting()) {
    if (text_of_model(request) == nullptr || texts_.find(key_of(request)) != nullptr) continue;
    if (is_unlimited() || budget_.allows(account_of(request.client), now()))
      first_of.try_emplace(request.client, &request);
  }
  if (first_of.empty()) return nullptr;
  const auto next = first_of.upper_bound(last_read_for_);
  return next == first_of.end() ? first_of.begin()->second : next->second;
}

bool Control::has_work() {
  read_texts();
  return std::ranges::any_of(ledger_.waiting(), [this](const Request& request) { return may_be_done(request); });
}

// Returns the next request that may be carried out, and the actions that directly follow it, which are carried out
// together. The requests of one client keep their order.
std::vector<Request> Control::take_next(Moment moment) {
  std::deque<Request>& waiting = ledger_.waiting();
  std::set<std::uint64_t> held_up;
  std::vector<Request> taken;
  for (std::size_t i = 0; i < waiting.size();) {
    const Request& request = waiting[i];
    const bool is_question = is_query(request);
    const bool is_now = moment == Moment::boundary || is_question || ends_the_run(request);
    const bool waits_for_another = moment == Moment::boundary && !is_question && held_up.contains(request.client);
    if (!taken.empty() && !is_action(request)) break;
    if (!is_now || waits_for_another || !may_be_done(request)) {
      if (is_now && !is_question) held_up.insert(request.client);
      ++i;
      continue;
    }
    taken.push_back(std::move(waiting[i]));
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i));
    if (!is_action(taken.back())) break;
  }
  return taken;
}

bool Control::perform(Moment moment) {
  saved_.reset();
  drop_what_is_too_much();
  read_texts();
  while (!ending_) {
    const std::vector<Request> next = take_next(moment);
    if (next.empty()) break;
    const RequestBudget::Time began = now();
    if (is_action(next.front()))
      do_actions(next);
    else if (is_query(next.front()))
      answer_query(next.front());
    else
      do_one(next.front());
    for (const Request& request : next)
      charge(request, (now() - began) / static_cast<RequestBudget::Time::rep>(next.size()));
  }
  return !ending_;
}

void Control::drop_what_is_too_much() {
  std::vector<KeptForClient> kept;
  ledger_.list(kept);
  recordings_.list(kept);
  for (const KeptForClient& each : what_goes(std::move(kept), most_kept_for_clients)) {
    const std::string text = name_of(each.kind) + " dropped: more than " +
                             std::to_string(most_kept_for_clients >> 20U) +
                             " MiB are kept for all clients, and this was the oldest";
    run_->monitor.add_event("dropped", text + ", of " + label_of(each.client));
    if (each.kind == KeptForClient::Kind::recording)
      recordings_.drop(each.client, text);
    else
      ledger_.drop(each, text);
  }
}

}  // namespace cohort::session
