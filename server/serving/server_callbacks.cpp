// SPDX-License-Identifier: Apache-2.0
#include "server/serving/server.hpp"

// The server's functions on other threads than that of the run: those of DDS, those that report ended processes, and
// the one that reads model texts.
namespace cohort::session {
namespace {

std::string answer_to(std::uint64_t tick) { return "an answer to tick " + std::to_string(tick); }

}  // namespace

// `add` returns true if the thread of the run has to read the inbox.
template <class Add>
void Server::put_aside(const Add& add) {
  const std::lock_guard lock(mutex_);
  if (add()) wake_.notify_all();
}

Endpoints::Callbacks Server::callbacks(wire::Participant& participant) {
  return {
      .joins = {[this, &participant](const wire::Join& join, const wire::Sender& sender) {
                  put_aside([&] { return inbox_.add_arrival(join, sender, &participant); });
                },
                [this](const wire::Sender& sender, bool alive) {
                  put_aside([&] { return inbox_.add_liveliness(sender, alive); });
                }},
      .commands = {[this](const wire::Command& command, const wire::Sender& sender) { on_command(command, sender); },
                   {}},
      .reports = {[this](const wire::Report& report, const wire::Sender& sender) { on_report(report, sender); }, {}},
      .requests = {[this, &participant](const wire::Request& request, const wire::Sender& sender) {
                     put_aside([&] { return inbox_.add_request(request, sender, &participant); });
                   },
                   [this](const wire::Sender& sender, bool alive) {
                     if (!alive) put_aside([&] { return inbox_.add_gone_requester(sender); });
                   }},
      .states = {[this](const wire::ControllerState& state, const wire::Sender& sender) { on_state(state, sender); },
                 {}},
      .foreign_version = [this](std::uint32_t major) { put_aside([&] { return inbox_.add_foreign_version(major); }); }};
}

void Server::on_report(const wire::Report& report, const wire::Sender& sender) {
  if (report.kind != wire::ReportKind::failed) return;  // clients report nothing else
  put_aside([&] {
    if (clients_.is_in_own_name(report.client, sender)) return inbox_.add_report(report, sender);
    inbox_.reject(sender.participant, "foreign", "a Report has the id of " + wire::partition_of(report.client));
    return false;
  });
}

void Server::on_state(const wire::ControllerState& state, const wire::Sender& sender) {
  put_aside([&] {
    if (clients_.is_in_own_name(state.client, sender)) return inbox_.add_state(state, sender);
    inbox_.reject(sender.participant, "foreign", "a ControllerState has the id of " + wire::partition_of(state.client));
    return false;
  });
}

void Server::on_command(const wire::Command& command, const wire::Sender& sender) {
  {
    const std::lock_guard lock(mutex_);
    if (!take_answer(command, sender)) return;
  }
  wake_.notify_all();  // without the lock, which the woken thread needs
}

// Requires the lock. Returns true if the run's thread has to continue.
bool Server::take_answer(const wire::Command& command, const wire::Sender& sender) {
  const auto reject = [&](std::uint64_t who, const char* reason, std::string_view text) {
    inbox_.reject(who, reason, text, command.tick);
    return false;
  };
  // Counts by the actual sender and not by the claimed id, as a stranger can claim any number of ids.
  if (!clients_.is_in_own_name(command.client, sender))
    return reject(sender.participant, "foreign",
                  "commands from a client that has not joined, or with another client's id");
  const lockstep::Leases::Lease* lease = run_ == nullptr ? nullptr : run_->leases.lease(command.client);
  if (lease == nullptr) return reject(command.client, "foreign", "commands from a client that drives no robot");
  ServedRun& run = *run_;
  if (command.run != run.number) return reject(command.client, "stale", answer_to(command.tick) + " of another run");
  if (command.epoch != lease->epoch)
    return reject(command.client, "stale", answer_to(command.tick) + " of another lease");

  const lockstep::Time now = Clock::now().time_since_epoch();
  const Exchange::Taken taken = run.exchange.take(lease->robots, command.tick, command.robots, command.values, now);
  if (taken.accepted > 0) run.leases.note_answer(command.client, now, command.tick, command.resent);
  if (taken.rejection) reject(command.client, taken.rejection->reason.c_str(), taken.rejection->text);
  if (taken.ends_run) run.fail(taken.rejection->text);
  return run.exchange.barrier().complete() || !run.error.empty();
}

void Server::note_news() {
  put_aside([&] { return inbox_.note_news(); });
}

void Server::fail(const std::string& error) {
  put_aside([&] { return inbox_.add_failure(error); });
}

void Server::note_process_end(std::uint32_t process) {
  put_aside([&] { return inbox_.add_ended_process(process); });
}

}  // namespace cohort::session
