#include <utility>

#include "server/session/control/control.hpp"

// What begins a run anew, and what is kept of one.
namespace cohort::session {

using wire::Reply;
using wire::Request;
using wire::ResultCode;

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
  const SessionSnapshot snapshot = run_->take_snapshot();
  std::vector<std::byte> bytes = to_bytes(snapshot);
  if (bytes.size() > wire::largest_data)
    return answer(request, ResultCode::operation_failed,
                  "the snapshot has " + std::to_string(bytes.size()) + " bytes, and " +
                      std::to_string(wire::largest_data) + " can be sent at the most");
  tell(request, "saved at tick " + std::to_string(snapshot.tick));
  Reply reply = reply_to(request);
  reply.size = bytes.size();
  reply.error_message = "saved at tick " + std::to_string(snapshot.tick);
  ledger_.offer(request.client, std::move(bytes));
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

}  // namespace cohort::session
