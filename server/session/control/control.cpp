#include "server/session/control/control.hpp"

#include <exception>
#include <utility>

#include "server/session/control/control_actions.hpp"
#include "server/session/control/request_checks.hpp"
#include "server/session/printable.hpp"

namespace cohort::session {
namespace {

using wire::Operation;
using wire::Reply;
using wire::Request;
using wire::ResultCode;
using wire::SimulationState;

constexpr std::size_t most_requesters = 64;
constexpr std::size_t most_waiting_bytes = std::size_t{64} << 20;
constexpr std::size_t most_kept_bytes = std::size_t{256} << 20;
constexpr std::uint32_t scope_default = 0;
constexpr std::uint32_t scope_all = 255;
constexpr std::chrono::milliseconds last_reply{500};

SimulationState on_wire(PlaybackState state) {
  switch (state) {
    case PlaybackState::stopped: return SimulationState::stopped;
    case PlaybackState::playing: return SimulationState::playing;
    case PlaybackState::paused: break;
  }
  return SimulationState::paused;
}

// For people, after what was done.
std::string left_out_text(const SessionSnapshot& snapshot, const description::Experiment& experiment) {
  std::string text;
  for (const std::string& sentence : what_is_left_out(snapshot, experiment)) text += "; " + sentence;
  return text;
}

std::string ticks_text(std::uint64_t count) { return std::to_string(count) + (count == 1 ? " tick" : " ticks"); }

std::string speed_text(double speed) {
  return speed == 0.0 ? "as fast as it goes" : std::to_string(speed) + " simulated seconds per second at the most";
}

bool may_ask(const wire::Identity& identity, Operation operation) {
  return identity.may_control || (identity.door == wire::observers_door && wire::is_looking_on(operation));
}

bool ends_the_run(const Request& request) {
  switch (request.operation) {
    case Operation::reset_simulation:
    case Operation::load_snapshot:
    case Operation::go_back: return true;
    case Operation::set_simulation_state:
      return request.state == SimulationState::stopped || request.state == SimulationState::quitting;
    default: return false;
  }
}

}  // namespace

void Control::begin(ControlledRun run) {
  run_.emplace(std::move(run));
  ending_.reset();
  playback_ = Playback(run_->monitor.options().state);
  queries_.begin(*run_);
  if (!std::exchange(goes_back_, false))
    kept_ =
        KeptSnapshots(static_cast<std::uint64_t>(run_->monitor.options().keep_interval / run_->experiment.world.step),
                      most_kept_bytes);
  const auto& from = run_->monitor.options().from;
  for (const Request& request : std::exchange(answered_by_next_run_, {}))
    answer(request, ResultCode::ok,
           "run " + std::to_string(run_->number) + " stands at tick " + std::to_string(run_->simulation.tick()) +
               ", with seed " + std::to_string(run_->experiment.seed) +
               (from ? left_out_text(*from, run_->experiment) : std::string()));
}

void Control::end(RunResult::End how) {
  const std::string at = "the run has ended at tick " + std::to_string(run_->simulation.tick());
  answer_steps(playback_.set(PlaybackState::playing), ResultCode::operation_failed, at);
  for (const Request& request : std::exchange(ledger_.waiting(), {})) answer(request, ResultCode::incorrect_state, at);
  const bool goes_on = how == RunResult::End::reset || how == RunResult::End::restored;
  if (!goes_on)  // the server may be gone soon
    for (auto& [id, requester] : requesters_) requester.replies.wait_until_received(last_reply);
  run_.reset();
}

wire::Reply Control::reply_to(const Request& request) {
  Reply reply;
  reply.client = request.client;
  reply.number = request.number;
  reply.operation = request.operation;
  return reply;
}

Control::Requester* Control::requester_of(const ReceivedRequest& received) {
  const std::uint64_t client = received.request.client;
  client_of_writer_[received.sender.writer] = client;
  if (const auto known = requesters_.find(client); known != requesters_.end()) {
    known->second.writer = received.sender.writer;
    return &known->second;
  }
  if (requesters_.size() >= most_requesters) return nullptr;
  const auto& identity = received.participant->identity();
  return &requesters_
              .emplace(client,
                       Requester{.label = printable(received.request.label) +
                                          (identity ? " ('" + identity->name + "')" : std::string()),
                                 .writer = received.sender.writer,
                                 .replies = wire::Writer<Reply>(*received.participant, wire::partition_of(client))})
              .first->second;
}

void Control::take(const ReceivedRequest& received) {
  const Request& request = received.request;
  const auto reject = [&](const std::string& text) { run_->monitor.add_event("rejected", text); };
  if (request.client == 0 || !ledger_.is_in_own_name(request.client, received.sender.participant))
    return reject("foreign: a Request comes in another's name, or in nobody's");
  if (requester_of(received) == nullptr)
    return reject("flood: " + std::to_string(most_requesters) + " clients control this run already");
  if (const auto& identity = received.participant->identity(); identity && !may_ask(*identity, request.operation)) {
    reject("forbidden: " + label_of(request.client) + " may not control the run");
    Reply reply = reply_to(request);
    reply.result = ResultCode::not_permitted;
    reply.error_message = "the identity '" + identity->name +
                          "' may not control the run: 'cohort security' gives that right as 'control'";
    return send(std::move(reply), false);
  }
  receive(request);
}

void Control::receive(const Request& request) {
  const auto refuse = [&](ResultCode result, const std::string& text) {
    Reply reply = reply_to(request);
    reply.result = result;
    reply.error_message = text;
    send(std::move(reply), false);
  };
  if (request.number == 0) return refuse(ResultCode::malformed, "requests are numbered from 1");
  if (const std::string wrong = what_is_wrong(request); !wrong.empty())
    return refuse(wire::name_of(request.operation).empty() ? ResultCode::feature_unsupported : ResultCode::malformed,
                  wrong);
  if (wire::is_query(request.operation)) {
    Reply reply = reply_to(request);
    queries_.answer(reply, request);
    return send(std::move(reply), false);
  }
  switch (ledger_.receive(request.client, request.number)) {
    case RequestLedger::Receipt::under_way: return;  // its reply comes
    case RequestLedger::Receipt::answered: return send(ledger_.remembered(request.client, request.number), false);
    case RequestLedger::Receipt::forgotten:
      return refuse(ResultCode::forgotten, "request " + std::to_string(request.number) +
                                               " is older than what is remembered: numbers have to ascend");
    case RequestLedger::Receipt::too_many:
      return refuse(ResultCode::operation_failed,
                    "more than " + std::to_string(wire::requests_under_way) + " requests of one client wait already");
    case RequestLedger::Receipt::fresh: break;
  }
  std::size_t bytes = size_of(request);
  for (const Request& waiting : ledger_.waiting()) bytes += size_of(waiting);
  if (bytes > most_waiting_bytes) return answer(request, ResultCode::operation_failed, "too much waits already");
  ledger_.waiting().push_back(request);
}

void Control::lose(const wire::Sender& sender) {
  const auto found = client_of_writer_.find(sender.writer);
  if (found == client_of_writer_.end()) return;
  const std::uint64_t client = found->second;
  client_of_writer_.erase(found);
  const auto requester = requesters_.find(client);
  // One that was lost and found again has another writer, and the end of the former comes late.
  if (requester == requesters_.end() || requester->second.writer != sender.writer) return;
  requesters_.erase(requester);
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
  if (is_kept) ledger_.keep(reply);
  const auto requester = requesters_.find(reply.client);
  if (requester != requesters_.end()) requester->second.replies.write(reply);  // lost: it is asked for again
}

void Control::answer(const Request& request, ResultCode result, const std::string& text) {
  Reply reply = reply_to(request);
  reply.result = result;
  reply.error_message = text;
  send(std::move(reply), true);
}

void Control::answer_steps(const std::vector<Playback::Steps>& steps, ResultCode result, const std::string& text) {
  for (const Playback::Steps& each : steps) {
    const Request request{.client = each.client, .number = each.number, .operation = Operation::step_simulation};
    const std::uint64_t tick = run_->simulation.tick();
    answer(request, result,
           each.until > tick ? text + ", " + ticks_text(each.until - tick) + " before the steps' end" : text);
  }
}

std::string Control::label_of(std::uint64_t client) const {
  const auto found = requesters_.find(client);
  return found == requesters_.end() ? "a client that has gone" : found->second.label;
}

void Control::tell(const Request& request, const std::string& text, std::vector<std::byte> action) {
  run_->monitor.controlled({run_->simulation.tick(), wire::name_of(request.operation),
                            text + ", says " + label_of(request.client), std::move(action)});
}

void Control::reach_boundary() {
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
    // A controller has failed: the run ends by that.
  }
}

bool Control::perform(Moment moment) {
  saved_.reset();
  std::deque<Request>& waiting = ledger_.waiting();
  for (std::size_t i = 0; i < waiting.size() && !ending_;) {
    if (moment == Moment::midst && !ends_the_run(waiting[i])) {
      ++i;
      continue;
    }
    // Actions that follow each other are done together.
    std::vector<Request> now;
    do {
      now.push_back(std::move(waiting[i]));
      waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i));
    } while (i < waiting.size() && is_action(now.back()) && is_action(waiting[i]));
    if (is_action(now.front()))
      do_actions(now);
    else
      do_one(now.front());
  }
  return !ending_;
}

void Control::do_one(const Request& request) {
  try {
    switch (request.operation) {
      case Operation::set_simulation_state: return set_state(request);
      case Operation::step_simulation: return step(request);
      case Operation::reset_simulation: {
        if (request.scope != scope_default && request.scope != scope_all)
          return answer(request, ResultCode::feature_unsupported, "only all can be reset: scope 0 or 255");
        const std::uint64_t seed = request.set_seed ? request.seed : run_->experiment.seed;
        NextRun next{.seed = seed, .state = playback_.state_without_steps(), .speed = run_->monitor.speed()};
        return begin_anew(request, std::move(next), "from the beginning with seed " + std::to_string(seed));
      }
      case Operation::set_speed: return set_speed(request);
      case Operation::save_snapshot: return save(request);
      case Operation::load_snapshot: return load(request);
      case Operation::go_back: return go_back(request);
      case Operation::start_recording: return start_recording(request);
      default:
        return answer(request, ResultCode::feature_unsupported, wire::name_of(request.operation) + " is not there yet");
    }
  } catch (const std::exception& error) {
    answer(request, ResultCode::operation_failed, error.what());
  }
}

void Control::set_state(const Request& request) {
  const auto be = [&](PlaybackState state, const std::string& word) {
    const bool already = playback_.state() == state;
    if (already && !playback_.has_steps())
      return answer(request, ResultCode::already_in_target_state, "the run is " + word + " already");
    const bool was_held = playback_.holds();
    const std::string at = word + " at tick " + std::to_string(run_->simulation.tick());
    answer_steps(playback_.set(state), ResultCode::operation_failed, at);
    if (was_held) run_->monitor.resume();
    tell(request, at);
    answer(request, ResultCode::ok, at);
  };
  switch (request.state) {
    case SimulationState::playing: return be(PlaybackState::playing, "playing");
    case SimulationState::paused: return be(PlaybackState::paused, "paused");
    case SimulationState::quitting: return quit(request);
    case SimulationState::stopped: break;
  }
  if (playback_.state() == PlaybackState::stopped)
    return answer(request, ResultCode::already_in_target_state, "the run is stopped already");
  begin_anew(request, {.seed = run_->experiment.seed, .state = PlaybackState::stopped, .speed = run_->monitor.speed()},
             "stopped, and from the beginning");
}

void Control::step(const Request& request) {
  if (playback_.state_without_steps() == PlaybackState::playing)
    return answer(request, ResultCode::operation_failed, "the run is not paused, so it makes steps by itself");
  if (run_->monitor.is_over()) return answer(request, ResultCode::incorrect_state, "the run is over");
  const bool was_held = playback_.holds();
  playback_.step(run_->simulation.tick(), request.steps, request.client, request.number);
  if (was_held) run_->monitor.resume();
  tell(request, ticks_text(request.steps));
}

void Control::set_speed(const Request& request) {
  run_->monitor.set_speed(request.speed);
  tell(request, speed_text(request.speed));
  answer(request, ResultCode::ok, speed_text(request.speed));
}

void Control::quit(const Request& request) {
  tell(request, "the end");
  ending_ = Ending{};
  answer(request, ResultCode::ok, "the run ends at tick " + std::to_string(run_->simulation.tick()));
}

void Control::begin_anew(const Request& request, NextRun next, const std::string& text) {
  if (!run_->monitor.options().prepare)
    return answer(request, ResultCode::feature_unsupported, "this server cannot begin another run");
  run_->monitor.options().prepare(next);
  tell(request, text);
  answered_by_next_run_.push_back(request);
  const RunResult::End how = next.snapshot == nullptr ? RunResult::End::reset : RunResult::End::restored;
  ending_ = Ending{how, std::move(next)};
}

void Control::save(const Request& request) {
  if (!saved_) {
    const SessionSnapshot snapshot = run_->take_snapshot();
    saved_ = Saved{"saved at tick " + std::to_string(snapshot.tick) + left_out_text(snapshot, run_->experiment),
                   std::make_shared<const std::vector<std::byte>>(to_bytes(snapshot))};
  }
  if (saved_->bytes->size() > wire::largest_data)
    return answer(request, ResultCode::operation_failed,
                  "the snapshot has " + std::to_string(saved_->bytes->size()) + " bytes, and " +
                      std::to_string(wire::largest_data) + " can be sent at the most");
  tell(request, saved_->text);
  Reply reply = reply_to(request);
  reply.size = saved_->bytes->size();
  reply.error_message = saved_->text;
  ledger_.offer(request.client, saved_->bytes);
  send(std::move(reply), true);
}

void Control::start_recording(const Request& request) {
  if (run_->monitor.is_over()) return answer(request, ResultCode::incorrect_state, "the run is over");
  const std::string text = "recorded from tick " + std::to_string(run_->simulation.tick()) + " on";
  recordings_.start(request.client, request.resource_string);
  tell(request, text);
  answer(request, ResultCode::ok, text);
}

void Control::load(const Request& request) {
  const auto bytes = ledger_.take_all(request.client);
  if (!bytes)
    return answer(request, ResultCode::incorrect_state, "there is no snapshot to load: PutData brings it, whole");
  auto snapshot = std::make_shared<SessionSnapshot>(snapshot_from_bytes(*bytes));
  expect_same_experiment(*snapshot, run_->experiment);
  go_on_from(request, std::move(snapshot));
}

void Control::go_back(const Request& request) {
  if (kept_.size() == 0)
    return answer(request, ResultCode::not_found, "this server keeps no snapshots; --keep-snapshots lets it");
  const std::int64_t tick = request.duration_ns / run_->experiment.world.step.count();
  auto snapshot = tick < 0 ? nullptr : kept_.last_until(static_cast<std::uint64_t>(tick));
  if (snapshot == nullptr)
    return answer(request, ResultCode::not_found,
                  "the first snapshot that is kept is of tick " + std::to_string(kept_.first_tick()) +
                      ", the last of tick " + std::to_string(kept_.last_tick()) + "; none is at or before tick " +
                      std::to_string(tick));
  const std::uint64_t at = snapshot->tick;
  go_on_from(request, std::move(snapshot));
  if (!ending_) return;
  kept_.forget_after(at);
  goes_back_ = true;
}

void Control::go_on_from(const Request& request, std::shared_ptr<const SessionSnapshot> snapshot) {
  const std::string text = "from tick " + std::to_string(snapshot->tick) + " on";
  NextRun next{.seed = snapshot->seed, .state = playback_.state_without_steps(), .speed = run_->monitor.speed()};
  if (next.state == PlaybackState::stopped) next.state = PlaybackState::paused;
  next.snapshot = std::move(snapshot);
  begin_anew(request, std::move(next), text);
}

void Control::do_actions(std::span<const Request> requests) {
  saved_.reset();  // the world is another now
  for (ActionOutcome& outcome : act(run_->simulation, requests)) {
    for (ActionOutcome::Done& done : outcome.done) tell(*outcome.request, done.text, std::move(done.action));
    Reply reply = reply_to(*outcome.request);
    reply.result = outcome.result;
    reply.error_message = std::move(outcome.text);
    reply.entity = std::move(outcome.entity);
    send(std::move(reply), true);
  }
}

}  // namespace cohort::session
