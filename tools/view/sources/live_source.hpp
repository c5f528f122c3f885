// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "client_sdk/src/control/control_client.hpp"
#include "idl/dds/transport.hpp"
#include "tools/view/driving/drivers.hpp"
#include "tools/view/history/history_thread.hpp"
#include "tools/view/history/seen_values.hpp"
#include "tools/view/messages/scene_publisher.hpp"
#include "tools/view/source.hpp"
#include "tools/view/sources/live_history.hpp"

namespace cohort::view {

struct LiveOptions {
  std::string server = "127.0.0.1";
  std::uint32_t domain = 0;
  std::string secure{};          ///< folder of an observer's identity; empty: without security
  std::string secure_control{};  ///< folder of an identity that may control
  std::string secure_drive{};    ///< folder of an identity that may drive robots
  bool may_control = false;
  bool plays_when_seen = false;       ///< a run that begins paused starts when a page is open
  std::string again{};                ///< shell command that repeats the run, shown after the end
  std::function<void()> run_again{};  ///< repeats the run; null: the view cannot. Any thread.
  std::string recording{};            ///< name of the file that the run writes; empty: none
};

/// Shows a running server, as an observer, with the `history` of the values received. If it may control the run, it
/// accepts the requests `play`, `pause`, `step`, `speed`, `reset`, `spawn`, `remove`, `move`, `light` and `push`, and
/// the server decides whether they are executed. If the server keeps snapshots, `seek` and steps back are possible too.
/// They go to the last snapshot before the time and, if the run is paused, from there to the exact tick. With `drive`
/// and `release`, the page's user becomes the controller of a robot (Drivers).
class LiveSource final : public Source {
 public:
  /// Does not wait for the server. `topics` must outlive this. Throws wire::WireError if the server's address or the
  /// identity cannot be used.
  LiveSource(const LiveOptions& options, Topics& topics);
  ~LiveSource() override;

  void ask(const ViewRequest& request, std::function<void(const Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;
  void leave(std::uint64_t visitor) override;
  /// Returns whether the server has announced that no further run follows, or has disappeared after a run. Any thread.
  bool has_ended() const { return has_ended_; }
  /// Starts a run that waits for its first visitor (`plays_when_seen`). Any thread.
  void play_unseen() { plays_unseen_ = true; }

 private:
  using Bytes = recording::Bytes;

  struct ReceivedRequest {
    ViewRequest request;
    std::function<void(const Answer&)> answer;
  };
  // Data from the server since the last look. Under the lock.
  struct Arrived {
    std::optional<Bytes> scene{};
    Bytes frame{}, signals{}, contacts{}, robots{};
    bool has_update = false;
    bool has_other_watched = false;  // robots
  };
  struct End {
    std::string how, why;
  };

  void on_scene(const wire::SceneDescription& description);
  void on_update(const wire::SceneUpdate& update);
  void show_what_arrives();
  void show(Arrived& arrived);
  void begin();
  void end(End how);
  void show_extras();
  void show_robots();
  void serve_requests();
  Answer done(ControlClient& client, const ViewRequest& asked);
  Answer gone_back(ControlClient& client, std::chrono::nanoseconds time);
  void ask_status(ControlClient& client);
  void ask_history(ControlClient& client);
  void play_if_seen(ControlClient& client);
  void answer_all(const std::string& text);
  void drive(const ViewRequest& request, std::function<void(const Answer&)> answer);
  void show_status(const ViewStatus& status);
  ViewStatus status_without_run();
  std::string to_attach(const std::string& robot) const;

  const LiveOptions options_;
  Topics& topics_;
  ScenePublisher publisher_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<bool> has_server_{false};  // a server that can be controlled is there
  std::atomic<bool> has_ended_{false};
  std::atomic<bool> plays_unseen_{false};
  Drivers drivers_;

  std::mutex mutex_;
  std::condition_variable arrived_changed_;
  Arrived arrived_;
  std::vector<std::uint32_t> watched_;
  std::chrono::nanoseconds time_{0};  // simulated
  std::optional<End> end_;            // end of the last run, if no other run follows
  wire::SimulationStatus run_;        // latest status from the server; valid if had_run_
  bool had_run_ = false;

  std::mutex requests_mutex_;
  std::condition_variable requests_changed_;
  std::deque<ReceivedRequest> requests_;

  wire::Participant participant_;
  wire::Reader<wire::SceneDescription> descriptions_;
  wire::Reader<wire::SceneUpdate> updates_;
  // For the thread that publishes: messages of topics that only some clients read, and Topics::arrivals when they were
  // published last.
  Bytes contacts_;
  Bytes robots_;
  std::uint64_t arrivals_ = 0;
  std::uint32_t revision_ = 0;  // revision of the published scene; links_ is its number of links
  std::size_t links_ = 0;
  // For the thread that serves requests: the last messages of the server.
  LiveHistory history_;
  bool has_played_ = false;
  std::chrono::nanoseconds run_time_{0};
  SeenValues seen_;
  HistoryThread histories_;
  std::thread shower_;
  std::thread steward_;
};

}  // namespace cohort::view
