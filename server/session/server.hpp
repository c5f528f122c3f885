#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "idl/wire.hpp"
#include "server/lockstep/leases.hpp"
#include "server/lockstep/resend_timer.hpp"
#include "server/session/exchange.hpp"
#include "server/session/run.hpp"

namespace cohort::session {

/// Runs an experiment whose controllers are DDS clients: docs/protocol.md, the server's side. Callbacks of DDS put
/// control messages aside and take answers at once under one lock; everything else happens on the thread of `run`,
/// which alone creates and destroys entities and steps the world.
class Server {
 public:
  Server(const description::Experiment& experiment, Simulation& simulation, wire::Participant& participant,
         const RunOptions& options, RunListener listener);
  ~Server();

  /// Waits for a controller for every robot, runs, and tells the controllers when it is over. Returns soon after `stop`
  /// is set, also while it waits.
  RunResult run(const std::atomic<bool>& stop);

  /// Ends the run with this error, from any thread, unless a controller has reported one before.
  void fail(const std::string& error);

 private:
  std::string error();

  using Clock = RunBook::Clock;

  struct Client {
    std::string label;                    // for people: controller, process and host
    std::vector<std::uint32_t> robots{};  // that it last asked for
    bool claims = false;                  // and was neither granted nor refused
    wire::Writer<wire::Admit> admit;
    wire::Writer<wire::Observation> observation;
    wire::Writer<wire::Report> report;
    lockstep::ResendTimer resend{};
    std::uint32_t times_resent = 0;
    Exchange::Frame frame{};                      // reused
    std::set<std::string> reported_rejections{};  // reasons that it was told of
  };
  struct Liveliness {
    wire::Sender sender;
    bool alive = false;
  };
  // What DDS's threads leave for the thread of `run`.
  struct Inbox {
    std::vector<std::pair<wire::Join, wire::Sender>> joins;
    std::vector<Liveliness> liveliness;
    std::vector<wire::Report> reports;
    std::string failure;  // of something outside
    std::map<std::pair<std::uint64_t, std::string>, std::pair<std::string, std::uint64_t>> rejected;  // text, count
    bool empty() const {
      return joins.empty() && liveliness.empty() && reports.empty() && failure.empty() && rejected.empty();
    }
  };

  // On DDS's threads.
  void on_join(const wire::Join& join, const wire::Sender& sender);
  void on_liveliness(const wire::Sender& sender, bool alive);
  void on_command(const wire::Command& command, const wire::Sender& sender);
  void on_report(const wire::Report& report, const wire::Sender& sender);
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const;
  void reject(std::uint64_t client, const std::string& reason, const std::string& text);

  // On the thread of `run`; those that take the lock must not hold it.
  bool wait_for_controllers(const std::atomic<bool>& stop);
  bool run_tick(const std::atomic<bool>& stop);
  void handle_inbox();
  void handle_join(const wire::Join& join, const wire::Sender& sender);
  void handle_liveliness(std::uint64_t client, bool alive);
  Client* attach(const wire::Join& join, const wire::Sender& sender, const std::set<std::uint32_t>& robots);
  void refuse(std::uint64_t client_id, Client& client, const std::string& reason);
  void decide_claims();
  void admit(const lockstep::Leases::Granted& granted);
  void send_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent);
  void send_frames();
  void resend_frames(Clock::time_point now);
  bool handle_misses(Clock::time_point now);
  Clock::time_point next_wake() const;
  bool is_awaited(std::uint64_t client) const;
  std::vector<std::uint64_t> frames_under_way(const std::vector<std::uint32_t>& robots) const;
  void report_progress(bool now_anyway);
  void publish_world_state();
  void end_clients(RunResult::End end, const std::string& text);
  std::string robots_text(const std::vector<std::uint32_t>& robots) const;
  std::string label_of(std::uint64_t client) const;

  const description::Experiment& experiment_;
  Simulation& simulation_;
  wire::Participant& participant_;
  RunBook book_;
  std::uint32_t run_number_ = 1;
  bool running_ = false;  // from the first frame on

  std::mutex mutex_;
  std::condition_variable wake_;
  // Under the lock: what answers need, and the inbox. `participant_of_client_`: who joined under an id; DDS says it, so
  // that nobody can answer in another's name.
  Exchange exchange_;
  lockstep::Leases leases_;
  Inbox inbox_;
  bool attention_ = false;  // wake up before the tick is complete
  std::string error_;

  std::map<std::uint64_t, std::uint64_t> participant_of_client_;

  std::map<std::uint64_t, Client> clients_;                  // by id
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;  // of Join
  lockstep::MedianDuration median_tick_;
  std::vector<std::uint32_t> all_robots_;
  Clock::time_point observers_counted_at_{};
  bool observed_ = false;
  std::vector<double> poses_;  // reused

  wire::Writer<wire::RobotDescription> descriptions_;
  wire::Writer<wire::WorldState> world_state_;
  // Last, so that no callback comes before all else is there or after it is gone.
  wire::Reader<wire::Join> joins_;
  wire::Reader<wire::Command> commands_;
  wire::Reader<wire::Report> reports_;
};

}  // namespace cohort::session
