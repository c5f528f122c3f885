#include <algorithm>

#include "server/description/select_robots.hpp"
#include "server/session/roster.hpp"
#include "server/session/server.hpp"

// Who is attached: joining, leaving, taking over, and what clients are told.
namespace cohort::session {
namespace {

constexpr std::chrono::seconds farewell{2};

}  // namespace

void Server::handle_inbox() {
  Inbox inbox;
  {
    const std::lock_guard lock(mutex_);
    if (inbox_.empty()) return;
    std::swap(inbox, inbox_);
  }
  for (const auto& [join, sender] : inbox.joins) handle_join(join, sender);
  for (const Liveliness& change : inbox.liveliness) {
    const auto found = client_of_writer_.find(change.sender.writer);
    if (found != client_of_writer_.end()) handle_liveliness(found->second, change.alive);
  }
  for (const wire::Report& report : inbox.reports) {
    const std::lock_guard lock(mutex_);
    if (leases_.lease(report.client) == nullptr) continue;  // it drives nothing: its troubles are its own
    book_.add_event("failed", label_of(report.client) + ": " + report.text);
    if (error_.empty()) error_ = report.text;
  }
  if (!inbox.failure.empty()) {
    const std::lock_guard lock(mutex_);
    if (error_.empty()) error_ = inbox.failure;
  }
  for (const auto& [key, value] : inbox.rejected) {
    const auto& [client_id, reason] = key;
    const auto& [text, count] = value;
    book_.add_event("rejected", reason + " from " + label_of(client_id) + ": " + text, count);
    if (reason == "repeated" || reason == "stale") continue;  // what a resent frame may bring about is no news to it
    const auto client = clients_.find(client_id);
    if (client == clients_.end() || !client->second.reported_rejections.insert(reason).second) continue;
    client->second.report.write({client_id, run_number_, wire::ReportKind::rejected, simulation_.tick(), reason, text});
  }
}

void Server::handle_liveliness(std::uint64_t client_id, bool alive) {
  const auto client = clients_.find(client_id);
  if (client == clients_.end()) return;
  bool useless = false;
  {
    const std::lock_guard lock(mutex_);
    if (const lockstep::Leases::Lease* lease = leases_.lease(client_id)) {
      if (lease->alive == alive) return;
      leases_.set_alive(client_id, alive);
      book_.add_event(alive ? "back" : "lost", client->second.label + " with " + robots_text(lease->robots) +
                                                   (alive ? " is back" : " is gone or does not respond"));
    } else if (client->second.claims) {
      // A claim counts only while its client lives; a stopped process that goes on has it back.
      if (alive) leases_.claim(client_id, client->second.robots);
      if (!alive) leases_.release(client_id);
    } else {
      useless = !alive;
    }
  }
  if (!useless) return;
  clients_.erase(client);
  std::erase_if(client_of_writer_, [&](const auto& writer) { return writer.second == client_id; });
  const std::lock_guard lock(mutex_);
  participant_of_client_.erase(client_id);
}

void Server::handle_join(const wire::Join& join, const wire::Sender& sender) {
  std::set<std::uint32_t> robots;
  std::string refusal;
  for (const std::string& selector : join.robots) {
    try {
      const auto selected = description::select_robots(experiment_.world, selector);
      robots.insert(selected.begin(), selected.end());
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
  }
  if (robots.empty() && refusal.empty()) refusal = "it asks for no robot";

  Client* client = attach(join, sender, robots);
  if (client == nullptr) return;
  if (!refusal.empty()) {
    refuse(join.client, *client, refusal);
    return;
  }
  client->robots.assign(robots.begin(), robots.end());
  client->claims = true;
  const std::lock_guard lock(mutex_);
  leases_.claim(join.client, client->robots);
}

// The client of this Join, with its writers. Null if somebody else has that id.
Server::Client* Server::attach(const wire::Join& join, const wire::Sender& sender,
                               const std::set<std::uint32_t>& robots) {
  {
    const std::lock_guard lock(mutex_);
    const auto [known, is_new] = participant_of_client_.emplace(join.client, sender.participant);
    if (!is_new && known->second != sender.participant) {
      book_.add_event("rejected", "foreign: a Join comes in the name of " + label_of(join.client));
      return nullptr;
    }
  }
  client_of_writer_[sender.writer] = join.client;
  if (const auto known = clients_.find(join.client); known != clients_.end()) return &known->second;

  int depth = 1;  // as many frames as can be under way
  for (const std::uint32_t robot : robots)
    depth = std::max(depth, static_cast<int>(simulation_.policy(robot).delay) + 1);
  const std::string partition = wire::partition_of(join.client);
  Client client{.label = join.controller + " (process " + std::to_string(join.process) + " on " + join.host + ")",
                .admit = wire::Writer<wire::Admit>(participant_, partition),
                .observation = wire::Writer<wire::Observation>(participant_, partition, depth),
                .report = wire::Writer<wire::Report>(participant_, partition)};
  return &clients_.emplace(join.client, std::move(client)).first->second;
}

void Server::refuse(std::uint64_t client_id, Client& client, const std::string& reason) {
  wire::Admit answer;
  answer.client = client_id;
  answer.status = wire::AdmitStatus::refused;
  answer.reason = reason;
  answer.run = run_number_;
  client.admit.write(answer);
  client.claims = false;
  book_.add_event("refused", client.label + ": " + reason);
}

// Claims are granted at boundaries, and in the midst of a tick to whoever takes over a robot that it waits for.
void Server::decide_claims() {
  lockstep::Leases::Decisions decisions;
  {
    const std::lock_guard lock(mutex_);
    if (!leases_.has_claims()) return;
    const lockstep::Barrier& barrier = exchange_.barrier();
    const bool at_boundary = barrier.complete();
    decisions = leases_.decide([&](const std::vector<std::uint32_t>& robots) {
      return at_boundary || std::ranges::any_of(robots, [&](auto robot) { return barrier.is_awaited(robot); });
    });
  }
  for (const auto& refused : decisions.refused)
    refuse(refused.client, clients_.at(refused.client),
           simulation_.robot_name(refused.robot) + " is driven by " + label_of(refused.holder));
  for (const auto& granted : decisions.granted) admit(granted);
}

void Server::admit(const lockstep::Leases::Granted& granted) {
  for (const std::uint64_t loser : granted.superseded) {
    const std::string text = label_of(granted.client) + " has taken its robots over";
    clients_.at(loser).report.write(
        {loser, run_number_, wire::ReportKind::superseded, simulation_.tick(), "superseded", text});
    book_.add_event("superseded", label_of(loser) + ": " + text);
  }

  std::vector<std::uint64_t> frames;  // under way: asked of whoever had the robots before, and not answered
  wire::Admit answer;
  {
    const std::lock_guard lock(mutex_);
    const lockstep::Leases::Lease& lease = *leases_.lease(granted.client);
    if (running_) frames = frames_under_way(lease.robots);
    answer.client = granted.client;
    answer.run = run_number_;
    answer.epoch = lease.epoch;
    answer.start_reason = running_ ? wire::StartReason::takeover : wire::StartReason::first;
    answer.tick = frames.empty() ? simulation_.tick() : frames.front();
    answer.step_ns = experiment_.world.step.count();
    admit_robots(answer, experiment_, simulation_, lease.robots);
    if (!granted.again) book_.add_event("joined", label_of(granted.client) + " drives " + robots_text(lease.robots));
  }
  Client& client = clients_.at(granted.client);
  client.claims = false;
  client.admit.write(answer);
  for (const std::uint64_t tick : frames) send_frame(granted.client, client, tick, false);
  client.resend.start(Clock::now().time_since_epoch(), median_tick_.value());
  client.times_resent = 0;
}

// Unanswered frames whose answers can still act. Under the lock.
std::vector<std::uint64_t> Server::frames_under_way(const std::vector<std::uint32_t>& robots) const {
  std::set<std::uint64_t> ticks;
  for (const std::uint32_t robot : robots)
    for (const std::uint64_t tick : exchange_.barrier().unanswered(robot))
      if (tick + simulation_.policy(robot).delay >= simulation_.tick()) ticks.insert(tick);
  return {ticks.begin(), ticks.end()};
}

// Says that the run is over, and waits a little until the clients have left: what is not delivered when the participant
// goes is lost.
void Server::end_clients(RunResult::End end, const std::string& text) {
  const bool failed = end == RunResult::End::failed;
  const wire::ReportKind kind = failed ? wire::ReportKind::failed : wire::ReportKind::finished;
  const std::string reason = failed ? "failed" : end == RunResult::End::finished ? "complete" : "interrupted";
  std::set<std::uint64_t> drivers;
  std::set<std::uint64_t> staying;  // of those, the ones that can hear it
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, lease] : leases_.all()) {
      drivers.insert(id);
      if (lease.alive) staying.insert(id);
    }
  }
  for (const std::uint64_t id : drivers)
    clients_.at(id).report.write({id, run_number_, kind, simulation_.tick(), reason, text});

  const Clock::time_point until = Clock::now() + farewell;
  std::unique_lock lock(mutex_);
  while (!staying.empty() && Clock::now() < until) {
    wake_.wait_until(lock, until, [&] { return !inbox_.liveliness.empty(); });
    for (const Liveliness& change : inbox_.liveliness) {
      const auto found = client_of_writer_.find(change.sender.writer);
      if (found != client_of_writer_.end() && !change.alive) staying.erase(found->second);
    }
    inbox_.liveliness.clear();
  }
}

std::string Server::robots_text(const std::vector<std::uint32_t>& robots) const {
  if (robots.empty()) return "no robot";
  std::string text = simulation_.robot_name(robots.front());
  if (robots.size() > 1) text += " and " + std::to_string(robots.size() - 1) + " more";
  return text;
}

std::string Server::label_of(std::uint64_t client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? "unknown client " + wire::partition_of(client) : found->second.label;
}

}  // namespace cohort::session
