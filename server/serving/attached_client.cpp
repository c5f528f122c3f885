// SPDX-License-Identifier: Apache-2.0
#include "server/serving/attached_client.hpp"

namespace cohort::session {
namespace {

std::string label_of(const wire::Join& join, const std::optional<wire::Identity>& identity) {
  return join.controller + " (process " + std::to_string(join.process) + " on " + join.host +
         (identity ? ", '" + identity->name + "')" : ")");
}

}  // namespace

AttachedClient::AttachedClient(const Inbox::Arrival& arrival, std::uint64_t its_place)
    : join(arrival.join),
      place(its_place),
      identity(arrival.participant->identity()),
      label(label_of(join, identity)),
      admit(*arrival.participant, wire::partition_of(join.client)),
      observation(*arrival.participant, wire::partition_of(join.client)),
      report(*arrival.participant, wire::partition_of(join.client)),
      participant_(*arrival.participant) {}

void AttachedClient::begin_run() {
  claims = false;
  robots.clear();
  more.clear();
  drives_first.clear();
  reported_rejections.clear();
  answer_times = {};
  late = rejected = resent_count = 0;
  state = {};
}

void AttachedClient::refuse(ServedRun& run, const ClaimRefusal& refusal) {
  wire::Admit answer;
  answer.client = id();
  answer.status = wire::known_to(join.minor, refusal.status);
  answer.reason = refusal.text;
  answer.run = run.number;
  send(admit, answer, &run);
  claims = false;
  run.monitor.add_event("refused", label + ": " + refusal.text);
}

void AttachedClient::fill_frame(ServedRun& run, std::uint64_t tick, bool resent) {
  frame.robots.clear();
  const lockstep::Leases::Lease* lease = run.leases.lease(id());
  if (lease == nullptr) return;
  if (!resent) {
    resend.note_answer(lease->answered_tick, lease->answered_copy, lease->answered_at);
    note_answers(run);
  }
  run.exchange.fill_frame(frame, lease->robots, tick);
  epoch = lease->epoch;
}

void AttachedClient::write_frame(ServedRun& run, std::uint64_t tick, bool resent) {
  wire::Observation message;
  message.client = id();
  message.run = run.number;
  message.resent = resent ? times_resent : 0;
  message.epoch = epoch;
  message.tick = tick;
  message.time_ns = (run.experiment.world.step * static_cast<std::int64_t>(tick)).count();
  message.robots = frame.robots;
  message.values = frame.values;
  if (!resent) {
    const lockstep::Time now = RunMonitor::Clock::now().time_since_epoch();
    resend.start(tick, now);
    answer_times.sent(tick, now);
  }
  send(observation, message, &run);  // sent again if it is lost
}

void AttachedClient::send_state(wire::ControllerState message, ServedRun& run) {
  message.client = id();
  message.run = run.number;
  message.epoch = epoch;
  try {
    if (!states_) states_.emplace(participant_, wire::partition_of(id()));
    send(*states_, message, &run);  // the client asks again for lost parts
  } catch (const wire::WireError& error) {
    run.monitor.add_event("unsent", label + ": " + error.what());
  }
}

wire::ControllerStatus AttachedClient::status(ServedRun& run) {
  note_answers(run);
  const lockstep::Leases::Lease& lease = *run.leases.lease(id());
  const lockstep::LatencyHistogram& times = answer_times.histogram();
  wire::ControllerStatus status;
  status.label = label;
  status.client = id();
  status.robots = lease.robots;
  status.alive = lease.alive;
  status.awaited = run.started && run.is_awaited(id());
  status.awaited_ns = status.awaited ? run.waiting().count() : 0;
  status.due_tick = run.due_tick_of(lease.robots);
  status.answers = lease.answer_count;
  status.late = late;
  status.rejected = rejected;
  status.resent = resent_count;
  status.answer_p50_ns = times.quantile(0.5).count();
  status.answer_p99_ns = times.quantile(0.99).count();
  return status;
}

void AttachedClient::note_answers(ServedRun& run) {
  run.leases.drain_news(id(), [&](const auto& news) { answer_times.answered(news.tick, news.at); });
}

}  // namespace cohort::session
