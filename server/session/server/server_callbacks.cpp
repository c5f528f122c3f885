#include "server/session/server/server.hpp"

// What arrives on DDS's threads: answers are taken at once, everything else is left for the thread of the run.
namespace cohort::session {
namespace {

// Beyond these, messages are counted and dropped: a flood must not fill the memory.
constexpr std::size_t most_arrivals = 4096;
constexpr std::size_t most_reports = 4096;
constexpr int answers_kept = 8;  // of each client, by DDS, until they are taken
std::string answer_to(std::uint64_t tick) { return "an answer to tick " + std::to_string(tick); }

}  // namespace

Server::Door::Door(Server& server, wire::Participant& its_participant)
    : participant(its_participant),
      descriptions(its_participant),
      joins(
          its_participant,
          {[&server, this](const wire::Join& join, const wire::Sender& sender) { server.on_join(*this, join, sender); },
           [&server](const wire::Sender& sender, bool alive) { server.on_liveliness(sender, alive); }}),
      commands(
          its_participant,
          {[&server](const wire::Command& command, const wire::Sender& sender) { server.on_command(command, sender); },
           {}},
          "", answers_kept),
      reports(its_participant,
              {[&server](const wire::Report& report, const wire::Sender& sender) { server.on_report(report, sender); },
               {}}),
      requests(its_participant,
               {[&server, this](const wire::Request& request, const wire::Sender& sender) {
                  server.on_request(*this, request, sender);
                },
                [&server](const wire::Sender& sender, bool alive) { server.on_requester(sender, alive); }}),
      versions(its_participant, [&server](std::uint32_t major) { server.on_foreign_version(major); }) {}

// Under the lock.
void Server::call_attention() {
  attention_ = true;
  wake_.notify_all();
}

void Server::on_join(Door& door, const wire::Join& join, const wire::Sender& sender) {
  const std::lock_guard lock(mutex_);
  if (inbox_.arrivals.size() >= most_arrivals)
    return reject(sender.participant, "flood", "more Joins than can be read");
  inbox_.arrivals.push_back({join, sender, &door});
  call_attention();
}

void Server::on_liveliness(const wire::Sender& sender, bool alive) {
  const std::lock_guard lock(mutex_);
  inbox_.liveliness.push_back({sender, alive});
  call_attention();
}

void Server::on_report(const wire::Report& report, const wire::Sender& sender) {
  if (report.kind != wire::ReportKind::failed) return;  // a client has nothing else to report
  const std::lock_guard lock(mutex_);
  if (!is_in_own_name(report.client, sender))
    return reject(sender.participant, "foreign", "a Report comes in the name of " + wire::partition_of(report.client));
  if (inbox_.reports.size() >= most_reports)
    return reject(sender.participant, "flood", "more Reports than can be read");
  inbox_.reports.push_back(report);
  call_attention();
}

void Server::on_foreign_version(std::uint32_t major) {
  constexpr std::size_t most = 100;  // more are a stranger's joke
  const std::lock_guard lock(mutex_);
  if (inbox_.foreign_versions.size() >= most || !inbox_.foreign_versions.insert(major).second) return;
  call_attention();
}

// Under the lock: whether DDS says that this comes from the process that joined under that id.
bool Server::is_in_own_name(std::uint64_t client, const wire::Sender& sender) const {
  const auto joined = participant_of_client_.find(client);
  return joined != participant_of_client_.end() && joined->second == sender.participant;
}

void Server::on_command(const wire::Command& command, const wire::Sender& sender) {
  {
    const std::lock_guard lock(mutex_);
    if (!take_answer(command, sender)) return;
  }
  wake_.notify_all();  // without the lock, which the one who wakes up needs
}

// Under the lock. True if the run's thread has to go on.
bool Server::take_answer(const wire::Command& command, const wire::Sender& sender) {
  const auto reject_it = [&](std::uint64_t who, const char* reason, std::string_view text) {
    reject(who, reason, text);
    return false;
  };
  // By who sent it, not by whose name it has: strangers may have as many names as they like.
  if (!is_in_own_name(command.client, sender))
    return reject_it(sender.participant, "foreign",
                     "commands come from a client that has not joined, or in another's name");
  const lockstep::Leases::Lease* lease = run_ == nullptr ? nullptr : run_->leases.lease(command.client);
  if (lease == nullptr) return reject_it(command.client, "foreign", "commands come from a client that drives no robot");
  if (command.run != run_number_)
    return reject_it(command.client, "stale", answer_to(command.tick) + " of another run");
  if (command.epoch != lease->epoch)
    return reject_it(command.client, "stale", answer_to(command.tick) + " of another lease");

  Run& run = *run_;
  const lockstep::Time now = Clock::now().time_since_epoch();
  const Exchange::Taken taken = run.exchange.take(lease->robots, command.tick, command.robots, command.values, now);
  if (taken.accepted > 0) run.leases.note_answer(command.client, now, command.tick, command.resent);
  if (taken.rejection) reject(command.client, taken.rejection->reason.c_str(), taken.rejection->text);
  if (taken.ends_run && run.error.empty()) run.error = taken.rejection->text;
  return run.exchange.barrier().complete() || !run.error.empty();
}

// Counted, and told by the thread of `run` when it next looks; a flood must not wake it for each message.
void Server::reject(std::uint64_t who, const char* reason, std::string_view text) {
  Rejections& rejections = inbox_.rejected[{who, reason}];
  if (rejections.count++ == 0) rejections.text = text;
}

void Server::fail(const std::string& error) {
  const std::lock_guard lock(mutex_);
  if (inbox_.failure.empty()) inbox_.failure = error;
  call_attention();
}

void Server::note_process_end(std::uint32_t process) {
  const std::lock_guard lock(mutex_);
  inbox_.ended_processes.push_back(process);
  call_attention();
}

}  // namespace cohort::session
