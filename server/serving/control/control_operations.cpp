// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <utility>
#include <variant>

#include "server/serving/control/control.hpp"
#include "server/serving/control/control_actions.hpp"
#include "server/serving/control/control_texts.hpp"
#include "server/serving/control/request_refusal.hpp"

namespace cohort::session {
namespace {

using wire::Reply;
using wire::Request;
using wire::ResultCode;
using wire::SimulationState;

constexpr std::uint32_t scope_default = 0;
constexpr std::uint32_t scope_all = 255;

std::string speed_text(double speed) {
  return speed == 0.0 ? "as fast as possible" : "at most " + std::to_string(speed) + " simulated seconds per second";
}

}  // namespace

void Control::answer_query(const Request& request) {
  Reply reply = reply_to(request);
  queries_.answer(reply, request);
  send(std::move(reply), false);
}

void Control::do_one(const Request& request) {
  try {
    std::visit(
        [&](const auto& operation) {
          if constexpr (requires { carry_out(request, operation); })
            carry_out(request, operation);
          else
            answer(request, ResultCode::feature_unsupported, wire::name_of(request.code()) + " is not supported yet");
        },
        request.operation);
  } catch (const RequestRefusal& refusal) {
    answer(request, refusal.result, refusal.what());
  } catch (const SnapshotError& error) {
    const bool is_save = request.code() == wire::OperationCode::save_snapshot;
    answer(request, is_save ? ResultCode::not_saved : ResultCode::invalid_snapshot, error.what());
  } catch (const std::exception& error) {
    answer(request, ResultCode::operation_failed, error.what());
  }
}

void Control::carry_out(const Request& request, const wire::SetSimulationState& operation) {
  const auto be = [&](PlaybackState state, const std::string& word) {
    const bool already = playback_.state() == state;
    if (already && !playback_.has_steps())
      return answer(request, ResultCode::already_in_target_state, "the run is already " + word);
    const bool was_held = playback_.holds();
    const std::string at = word + " at tick " + std::to_string(run_->simulation.tick());
    answer_steps(playback_.set(state), ResultCode::cancelled, at);
    if (was_held) run_->monitor.resume();
    tell(request, at);
    answer(request, ResultCode::ok, at);
  };
  switch (operation.state) {
    case SimulationState::playing: return be(PlaybackState::playing, "playing");
    case SimulationState::paused: return be(PlaybackState::paused, "paused");
    case SimulationState::quitting: return quit(request);
    case SimulationState::stopped: break;
  }
  if (playback_.state() == PlaybackState::stopped)
    return answer(request, ResultCode::already_in_target_state, "the run is already stopped");
  begin_anew(request, {.seed = run_->experiment.seed, .state = PlaybackState::stopped, .speed = run_->monitor.speed()},
             "stopped and reset to the beginning");
}

void Control::carry_out(const Request& request, const wire::ResetSimulation& operation) {
  if (operation.scope != scope_default && operation.scope != scope_all)
    return answer(request, ResultCode::feature_unsupported,
                  "only the whole simulation can be reset: expected scope 0 or 255");
  const std::uint64_t seed = operation.seed.value_or(run_->experiment.seed);
  begin_anew(request, {.seed = seed, .state = playback_.state_without_steps(), .speed = run_->monitor.speed()},
             "restarted with seed " + std::to_string(seed));
}

void Control::carry_out(const Request& request, const wire::StepSimulation& operation) {
  if (playback_.state_without_steps() == PlaybackState::playing)
    return answer(request, ResultCode::not_paused, "the run is not paused: pause it before stepping");
  if (run_->monitor.is_over()) return answer(request, ResultCode::incorrect_state, "the run is over");
  const bool was_held = playback_.holds();
  playback_.step(run_->simulation.tick(), operation.steps, request.client, request.number);
  if (was_held) run_->monitor.resume();
  tell(request, ticks_text(operation.steps));
}

void Control::carry_out(const Request& request, const wire::SetSpeed& operation) {
  run_->monitor.set_speed(operation.speed);
  tell(request, speed_text(operation.speed));
  answer(request, ResultCode::ok, speed_text(operation.speed));
}

void Control::advance_time(const Request& request, const wire::AdvanceTime& operation) {
  const std::string at = " at tick " + std::to_string(run_->simulation.tick());
  if (operation.release) {
    release_time(request.client, "has released it");
    return answer(request, ResultCode::ok, "the time is released" + at);
  }
  if (operation.steps == 0) {
    if (!time_holders_.has(request.client))
      tell(request, "time held from tick " + std::to_string(run_->simulation.tick()) + " on");
    time_holders_.add(request.client);
    return answer(request, ResultCode::ok, "the time is held" + at);
  }
  if (!time_holders_.has(request.client))
    return answer(request, ResultCode::time_not_held,
                  "this client does not hold the run's time: request 0 steps first");
  if (run_->monitor.is_over()) return answer(request, ResultCode::incorrect_state, "the run is over");
  time_holders_.ask(request.client, request.number, operation.steps);
}

void Control::grant_time() {
  const std::uint64_t tick = run_->simulation.tick();
  for (const TimeHolders::Grant& grant : time_holders_.take_grants(tick))
    answer({.client = grant.client, .number = grant.number, .operation = wire::AdvanceTime{}}, ResultCode::ok,
           "the time of tick " + std::to_string(tick));
}

void Control::release_time(std::uint64_t client, const std::string& why) {
  if (!time_holders_.remove(client) || !run_) return;
  run_->monitor.add_event("time", label_of(client) + ", which held the run's time, " + why + " at tick " +
                                      std::to_string(run_->simulation.tick()) + ": the run no longer waits for it");
}

std::string Control::time_holder() const {
  const auto client = time_holders_.awaited(run_->simulation.tick());
  return client ? label_of(*client) : "";
}

void Control::quit(const Request& request) {
  tell(request, "end of the run");
  ending_ = Ending{};
  answer(request, ResultCode::ok, "the run ends at tick " + std::to_string(run_->simulation.tick()));
}

void Control::begin_anew(const Request& request, NextRun next, const std::string& text) {
  if (!run_->monitor.options().prepare)
    return answer(request, ResultCode::feature_unsupported, "this server cannot start another run");
  run_->monitor.options().prepare(next);
  tell(request, text);
  answered_by_next_run_.push_back(request);
  budget_.begin_restart(account_of(request.client), Clock::now().time_since_epoch());
  const RunResult::End how = next.snapshot == nullptr ? RunResult::End::reset : RunResult::End::restored;
  ending_ = Ending{how, std::move(next)};
}

void Control::carry_out(const Request& request, const wire::SaveSnapshot&) {
  if (!saved_) {
    const SessionSnapshot snapshot = run_->take_snapshot();
    saved_ = Saved{"saved at tick " + std::to_string(snapshot.tick) + left_out_text(snapshot, run_->experiment),
                   std::make_shared<const std::vector<std::byte>>(to_bytes(snapshot))};
  }
  if (saved_->bytes->size() > wire::largest_data)
    return answer(request, ResultCode::too_large,
                  "the snapshot has " + std::to_string(saved_->bytes->size()) +
                      " bytes; the maximum that can be sent is " + std::to_string(wire::largest_data));
  tell(request, saved_->text);
  Reply reply = reply_to(request);
  reply.returned = wire::DataPart{saved_->bytes->size(), 0, {}};
  reply.error_message = saved_->text;
  ledger_.offer(request.client, saved_->bytes, Clock::now().time_since_epoch());
  send(std::move(reply), true);
}

void Control::carry_out(const Request& request, const wire::StartRecording& operation) {
  if (run_->monitor.is_over()) return answer(request, ResultCode::incorrect_state, "the run is over");
  const std::string text = "recorded from tick " + std::to_string(run_->simulation.tick()) + " on";
  recordings_.start(request.client, operation.recorded);
  tell(request, text);
  answer(request, ResultCode::ok, text);
}

void Control::carry_out(const Request& request, const wire::LoadSnapshot&) {
  const std::string why = ledger_.why_dropped(request.client, KeptForClient::Kind::upload);
  const auto bytes = ledger_.take_all(request.client);
  if (!bytes)
    return answer(request, ResultCode::incorrect_state,
                  "there is no snapshot to load: " +
                      (why.empty() ? std::string("send a whole snapshot with PutData first") : why));
  auto snapshot = std::make_shared<SessionSnapshot>(snapshot_from_bytes(*bytes));
  expect_same_experiment(*snapshot, run_->experiment);
  go_on_from(request, std::move(snapshot));
}

void Control::carry_out(const Request& request, const wire::GoBack& operation) {
  if (kept_.interval() == 0)
    return answer(request, ResultCode::not_found, "this server keeps no snapshots; start it with --keep-snapshots");
  if (kept_.size() == 0)
    return answer(request, ResultCode::not_found,
                  "no snapshot has been kept yet; one is kept at every multiple of " + ticks_text(kept_.interval()));
  const std::int64_t tick = operation.duration_ns / run_->experiment.world.step.count();
  auto snapshot = tick < 0 ? nullptr : kept_.last_until(static_cast<std::uint64_t>(tick));
  if (snapshot == nullptr)
    return answer(request, ResultCode::not_found,
                  "snapshots are kept from tick " + std::to_string(kept_.first_tick()) + " to tick " +
                      std::to_string(kept_.last_tick()) + "; none is at or before tick " + std::to_string(tick));
  const std::uint64_t at = snapshot->tick;
  go_on_from(request, std::move(snapshot));
  if (!ending_) return;
  kept_.forget_after(at);
  goes_back_ = true;
}

void Control::go_on_from(const Request& request, std::shared_ptr<const SessionSnapshot> snapshot) {
  const std::string text = "from tick " + std::to_string(snapshot->tick) + " on";
  begin_anew(request, run_from(std::move(snapshot)), text);
}

NextRun Control::run_from(std::shared_ptr<const SessionSnapshot> snapshot) const {
  NextRun next{.seed = snapshot->seed, .state = playback_.state_without_steps(), .speed = run_->monitor.speed()};
  if (next.state == PlaybackState::stopped) next.state = PlaybackState::paused;
  next.snapshot = std::move(snapshot);
  return next;
}

std::shared_ptr<const SessionSnapshot> Control::last_whole_snapshot() const {
  auto snapshot = kept_.last_until(run_->simulation.tick());
  while (snapshot != nullptr && !what_is_left_out(*snapshot, run_->experiment).empty())
    snapshot = snapshot->tick == 0 ? nullptr : kept_.last_until(snapshot->tick - 1);
  return snapshot;
}

void Control::rewind(const std::string& why) {
  NextRun next = run_from(last_whole_snapshot());
  const std::uint64_t at = next.snapshot->tick;
  next.rewound = why + ", so the run has gone back from tick " + std::to_string(run_->simulation.tick()) + " to tick " +
                 std::to_string(at) + ", where the state of all controllers was saved";
  run_->monitor.options().prepare(next);
  kept_.forget_after(at);
  goes_back_ = true;
  ending_ = Ending{RunResult::End::restored, std::move(next)};
}

void Control::do_actions(std::span<const Request> requests) {
  saved_.reset();  // the world has changed
  for (ActionOutcome& outcome : act(run_->simulation, requests, texts_)) {
    texts_.forget(key_of(*outcome.request));
    for (ActionOutcome::Done& done : outcome.done) tell(*outcome.request, done.text, std::move(done.action));
    Reply reply = reply_to(*outcome.request);
    reply.result = outcome.result;
    reply.error_message = std::move(outcome.text);
    reply.returned = wire::EntityName{std::move(outcome.entity)};
    send(std::move(reply), true);
  }
}

}  // namespace cohort::session
