#include <unistd.h>

#include <algorithm>

#include "server/description/select_robots.hpp"
#include "server/session/printable.hpp"
#include "server/session/roster.hpp"
#include "server/session/server/server.hpp"

// Who is attached: joining, leaving, taking over, staying from run to run, and what clients are told.
namespace cohort::session {
namespace {

constexpr std::chrono::seconds farewell{2};
// What a client may ask for and how many there may be, so that no stranger fills the memory or costs a tick's time.
constexpr std::size_t most_selectors = 4096;
constexpr std::size_t most_clients = 8192;

std::string host_name() {
  char name[256] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace

void Server::handle_inbox() {
  Inbox inbox;
  {
    const std::lock_guard lock(mutex_);
    if (inbox_.empty()) return;
    std::swap(inbox, inbox_);
  }
  for (const Arrival& arrival : inbox.arrivals) handle_arrival(arrival);
  for (const Liveliness& change : inbox.liveliness) {
    // Of the writer of its last Join: one that was lost and found again has another, and the end of the former comes
    // late.
    const auto found = client_of_writer_.find(change.sender.writer);
    if (found != client_of_writer_.end() && clients_.at(found->second).writer == change.sender.writer)
      handle_liveliness(found->second, change.alive);
  }
  for (const std::uint32_t process : inbox.ended_processes) {
    static const std::string here = host_name();
    std::vector<std::uint64_t> dead;
    for (const auto& [id, client] : clients_)
      if (client.join.process == process && client.join.host == here) dead.push_back(id);
    for (const std::uint64_t id : dead) handle_liveliness(id, false);
  }
  for (const wire::Report& report : inbox.reports) {
    const std::lock_guard lock(mutex_);
    if (run_->leases.lease(report.client) == nullptr) continue;  // it drives nothing: its troubles are its own
    run_->monitor.add_event("failed", label_of(report.client) + ": " + printable(report.text));
    if (run_->error.empty()) run_->error = report.text;
  }
  if (!inbox.failure.empty()) {
    const std::lock_guard lock(mutex_);
    if (run_->error.empty()) run_->error = inbox.failure;
  }
  for (const std::uint32_t major : inbox.foreign_versions)
    run_->monitor.add_event("version", "a client speaks version " + std::to_string(major) +
                                        " of the protocol, and this server version 1: they never meet. Install the "
                                        "same major version of Cohort on both sides");
  handle_rejections(inbox);
  for (const wire::Sender& sender : inbox.gone_requesters) control_.lose(sender);
  for (const ReceivedRequest& asked : inbox.requests) control_.take(asked);
}

void Server::handle_rejections(const Inbox& inbox) {
  for (const auto& [key, rejections] : inbox.rejected) {
    const auto& [client_id, reason] = key;
    run_->monitor.add_event("rejected", reason + " from " + label_of(client_id) + ": " + rejections.text,
                         rejections.count);
    const auto client = clients_.find(client_id);
    if (client != clients_.end()) client->second.rejected += rejections.count;
    if (reason == "repeated" || reason == "stale") continue;  // what a resent frame may bring about is no news to it
    if (client == clients_.end() || !client->second.reported_rejections.insert(reason).second) continue;
    client->second.report.write(
        {client_id, run_number_, wire::ReportKind::rejected, run_->simulation.tick(), reason, rejections.text});
  }
}

void Server::handle_liveliness(std::uint64_t client_id, bool alive) {
  const auto found = clients_.find(client_id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  client.alive = alive;
  bool useless = false;
  {
    const std::lock_guard lock(mutex_);
    if (const lockstep::Leases::Lease* lease = run_->leases.lease(client_id)) {
      if (lease->alive == alive) return;
      run_->leases.set_alive(client_id, alive);
      run_->monitor.add_event(alive ? "back" : "lost", client.label + " with " + robots_text(lease->robots) +
                                                        (alive ? " is back" : " is gone or does not respond"));
      // Nobody waits for a robot that does not need its controller.
      for (const std::uint32_t robot : lease->robots)
        if (!alive && !run_->simulation.policy(robot).required) run_->exchange.barrier().set_driven(robot, false);
    } else if (client.claims) {
      // A claim counts only while its client lives; a stopped process that goes on has it back.
      if (alive) run_->leases.claim(client_id, client.robots);
      if (!alive) run_->leases.release(client_id);
    } else {
      useless = !alive;
    }
  }
  if (useless) forget(client_id);
}

void Server::forget(std::uint64_t client_id) {
  clients_.erase(client_id);
  std::erase_if(client_of_writer_, [&](const auto& writer) { return writer.second == client_id; });
  const std::lock_guard lock(mutex_);
  participant_of_client_.erase(client_id);
}

void Server::handle_arrival(const Arrival& arrival) {
  Client* client = attach(arrival);
  if (client == nullptr) return;
  const bool is_news = !client->is_known || client->join.robots != arrival.join.robots;
  client->is_known = true;
  client->join = arrival.join;
  client->writer = arrival.sender.writer;
  handle_liveliness(arrival.join.client, true);
  // Clients join once a second, which only says that they live.
  if (is_news) claim(arrival.join.client, *client);
}

// What a client's selectors select in this run.
void Server::claim(std::uint64_t client_id, Client& client) {
  std::set<std::uint32_t> robots;
  std::string refusal;
  if (client.join.robots.size() > most_selectors)
    refusal = "it asks with more than " + std::to_string(most_selectors) + " selectors: ranges say more in one";
  for (const std::string& selector : client.join.robots) {
    if (!refusal.empty()) break;
    try {
      const auto selected = description::select_robots(run_->experiment.world, selector);
      robots.insert(selected.begin(), selected.end());
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
  }
  if (robots.empty() && refusal.empty()) refusal = "it asks for no robot";
  if (refusal.empty()) refusal = why_forbidden(client, robots);
  if (!refusal.empty()) return refuse(client_id, client, refusal);
  client.robots.assign(robots.begin(), robots.end());
  client.claims = true;
  const std::lock_guard lock(mutex_);
  run_->leases.claim(client_id, client.robots);
}

// Empty if its identity may drive them all, or if there is no security.
std::string Server::why_forbidden(const Client& client, const std::set<std::uint32_t>& robots) const {
  if (!client.identity) return {};
  const std::vector<std::string>& selectors = client.identity->robots;
  const std::string who = "its identity '" + client.identity->name + "' may ";
  if (selectors.empty()) return who + "look on, and drive no robot";
  // The same identities may serve several experiments, of which this one need not have all their robots.
  const auto allowed = description::select_robots_of_any(run_->experiment.world, selectors);
  const auto forbidden =
      std::ranges::find_if(robots, [&](std::uint32_t robot) { return !std::ranges::binary_search(allowed, robot); });
  if (forbidden == robots.end()) return {};
  std::string list;
  for (const std::string& selector : selectors) list += (list.empty() ? "" : ",") + selector;
  return who + "drive " + list + ", not " + run_->simulation.robot_name(*forbidden);
}

// At the beginning of a run: those who drove or waited claim what they asked for when they came, in the order of their
// coming.
void Server::claim_anew() {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> staying;  // by arrival
  std::vector<std::uint64_t> gone;
  for (auto& [id, client] : clients_) {
    if (!client.alive) gone.push_back(id);
    if (client.alive && (client.drove || client.claims)) staying.emplace_back(client.arrival, id);
    client.claims = false;
    client.robots.clear();
    client.reported_rejections.clear();
    client.answer_times = {};
    client.late = client.rejected = client.resent_count = 0;
  }
  for (const std::uint64_t id : gone) forget(id);
  std::ranges::sort(staying);
  for (const auto& [arrival, id] : staying) claim(id, clients_.at(id));
}

// The client of this Join, with its writers. Null if somebody else has that id.
Server::Client* Server::attach(const Arrival& arrival) {
  const wire::Join& join = arrival.join;
  {
    const std::lock_guard lock(mutex_);
    const auto [known, is_new] = participant_of_client_.emplace(join.client, arrival.sender.participant);
    if (!is_new && known->second != arrival.sender.participant) {
      run_->monitor.add_event("rejected", "foreign: a Join comes in the name of " + label_of(join.client));
      return nullptr;
    }
    if (is_new && clients_.size() >= most_clients) {
      participant_of_client_.erase(known);
      run_->monitor.add_event("rejected", "flood: there are " + std::to_string(most_clients) + " clients already");
      return nullptr;
    }
  }
  client_of_writer_[arrival.sender.writer] = join.client;
  if (const auto known = clients_.find(join.client); known != clients_.end()) return &known->second;

  wire::Participant& participant = arrival.door->participant;
  const std::string partition = wire::partition_of(join.client);
  Client client{.join = join,
                .arrival = arrivals_++,
                .identity = participant.identity(),
                .label = printable(join.controller) + " (process " + std::to_string(join.process) + " on " +
                         printable(join.host) +
                         (participant.identity() ? ", '" + participant.identity()->name + "')" : ")"),
                .admit = wire::Writer<wire::Admit>(participant, partition),
                .observation = wire::Writer<wire::Observation>(participant, partition),
                .report = wire::Writer<wire::Report>(participant, partition)};
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
  run_->monitor.add_event("refused", client.label + ": " + reason);
}

// Claims are granted at boundaries, and in the midst of a tick to whoever takes over a robot that it waits for.
void Server::decide_claims() {
  lockstep::Leases::Decisions decisions;
  {
    const std::lock_guard lock(mutex_);
    if (!run_->leases.has_claims()) return;
    const lockstep::Barrier& barrier = run_->exchange.barrier();
    const bool at_boundary = barrier.complete();
    decisions = run_->leases.decide(Clock::now().time_since_epoch(), [&](const std::vector<std::uint32_t>& robots) {
      return at_boundary || std::ranges::any_of(robots, [&](auto robot) { return barrier.is_awaited(robot); });
    });
  }
  for (const auto& refused : decisions.refused)
    refuse(refused.client, clients_.at(refused.client),
           run_->simulation.robot_name(refused.robot) + " is driven by " + label_of(refused.holder));
  for (const auto& granted : decisions.granted) admit(granted);
}

void Server::admit(const lockstep::Leases::Granted& granted) {
  for (const std::uint64_t loser : granted.superseded) {
    const std::string text = label_of(granted.client) + " has taken its robots over";
    clients_.at(loser).report.write(
        {loser, run_number_, wire::ReportKind::superseded, run_->simulation.tick(), "superseded", text});
    run_->monitor.add_event("superseded", label_of(loser) + ": " + text);
  }

  std::vector<std::uint64_t> frames;  // under way: asked of whoever had the robots before, and not answered
  wire::Admit answer;
  {
    const std::lock_guard lock(mutex_);
    const lockstep::Leases::Lease& lease = *run_->leases.lease(granted.client);
    // Of a restored run there are some before its first tick.
    if (run_->started || run_->monitor.options().from) frames = frames_under_way(lease.robots);
    answer.client = granted.client;
    answer.run = run_number_;
    answer.epoch = lease.epoch;
    answer.start_reason = why_it_starts(lease.robots, clients_.at(granted.client));
    for (const std::uint32_t robot : lease.robots) run_->was_driven[robot] = true;
    answer.tick = frames.empty() ? run_->simulation.tick() : frames.front();
    answer.step_ns = run_->experiment.world.step.count();
    admit_robots(answer, run_->experiment, run_->simulation, lease.robots);
    for (wire::AdmittedRobot& robot : answer.robots) robot.description = run_->descriptions[robot.description];
    if (!granted.again)
      run_->monitor.add_event("joined", label_of(granted.client) + " drives " + robots_text(lease.robots));
  }
  Client& client = clients_.at(granted.client);
  client.claims = false;
  client.admit.write(answer);
  for (const std::uint64_t tick : frames) send_frame(granted.client, client, tick, false);
  client.times_resent = 0;
}

// Under the lock.
wire::StartReason Server::why_it_starts(const std::vector<std::uint32_t>& robots, const Client& client) const {
  const bool takes_over = std::ranges::any_of(robots, [&](auto robot) { return run_->was_driven[robot]; });
  if (run_->started && takes_over) return wire::StartReason::takeover;
  if (!run_->started && run_->monitor.options().from) return wire::StartReason::restored;
  return client.drove ? wire::StartReason::reset : wire::StartReason::first;
}

// Unanswered frames whose answers can still act. Under the lock.
std::vector<std::uint64_t> Server::frames_under_way(const std::vector<std::uint32_t>& robots) const {
  std::set<std::uint64_t> ticks;
  for (const std::uint32_t robot : robots)
    for (const std::uint64_t tick : run_->exchange.barrier().unanswered(robot))
      if (tick + run_->simulation.policy(robot).delay >= run_->simulation.tick()) ticks.insert(tick);
  return {ticks.begin(), ticks.end()};
}

// What is not delivered when the participant goes is lost: hence the wait.
void Server::dismiss(const RunResult& last) {
  const bool failed = last.end == RunResult::End::failed;
  const wire::ReportKind kind = failed ? wire::ReportKind::failed : wire::ReportKind::finished;
  const std::string reason = failed ? "failed" : last.end == RunResult::End::finished ? "complete" : "interrupted";
  std::set<std::uint64_t> staying;  // of those who drove, the ones that can hear it
  for (auto& [id, client] : clients_) {
    if (!client.drove) continue;
    client.report.write({id, run_number_, kind, last.ticks, reason, last.error});
    if (client.alive) staying.insert(id);
  }

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

// Tells of the robots' kinds. An id is never used for two things, since clients keep what they were told in earlier
// runs.
void Server::publish_descriptions() {
  run_->descriptions.clear();
  for (wire::RobotDescription& kind : describe_kinds(run_->simulation)) {
    const auto known = std::ranges::find_if(descriptions_, [&](const wire::RobotDescription& other) {
      return other.model == kind.model && other.observation == kind.observation && other.command == kind.command;
    });
    kind.description = static_cast<std::uint32_t>(known - descriptions_.begin());
    run_->descriptions.push_back(kind.description);
    if (known != descriptions_.end()) continue;
    for (Door& door : doors_) door.descriptions.write(kind);
    descriptions_.push_back(std::move(kind));
  }
}

// At a boundary: robots that do not require a controller are asked from now on if they have one.
void Server::see_who_drives() {
  if (run_->undemanding.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t robot : run_->undemanding) {
    const auto holder = run_->leases.holder(robot);
    run_->exchange.barrier().set_driven(robot, holder && run_->leases.lease(*holder)->alive);
  }
}

std::string Server::robots_text(const std::vector<std::uint32_t>& robots) const {
  if (robots.empty()) return "no robot";
  std::string text = run_->simulation.robot_name(robots.front());
  if (robots.size() > 1) text += " and " + std::to_string(robots.size() - 1) + " more";
  return text;
}

std::string Server::label_of(std::uint64_t client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? "an unknown client" : found->second.label;
}

}  // namespace cohort::session
