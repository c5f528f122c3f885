// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/viewing/scene_maker.hpp"
#include "tools/python/native/array_simulation.hpp"
#include "tools/view/messages/scene_publisher.hpp"
#include "tools/view/source.hpp"
#include "tools/view/web/web_server.hpp"

namespace cohort::python {

/// A web server in this process that shows a simulation while a program steps it.
///
/// The program takes a turn for each operation that may change the simulation. During a turn, the program's thread
/// shows the simulation from time to time. Between turns nothing changes it, and a thread of the view shows the state
/// after the last turn. Nothing here needs Python's global interpreter lock.
class LiveView final : public view::Source, public std::enable_shared_from_this<LiveView> {
 public:
  /// Listens at 127.0.0.1 on `port`; without `port`, on 8080, or on any free port if that is in use. Shows the current
  /// simulation. Throws std::runtime_error if `port` is in use. `simulation` must outlive the open view.
  LiveView(const ArraySimulation& simulation, view::PageFiles page, std::optional<std::uint16_t> port);
  ~LiveView() override { close(); }

  std::uint16_t port() const { return port_; }
  bool is_closed() const { return is_closed_; }
  /// Ends the server and frees its port. Thread-safe, also during a turn. In a forked process, the parent's view
  /// continues. The owner calls it before the last reference is released.
  void close();

  /// Starts a turn of the program. Waits while the view reads the simulation.
  void begin_turn();
  /// Records a change of the simulation, and shows it if it is time. Call it during a turn.
  void changed();
  void end_turn();

  void ask(const view::ViewRequest& request, std::function<void(const view::Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;

 private:
  using Clock = std::chrono::steady_clock;

  // Data for the reader of the simulation: the program during its turn, the view between turns.
  struct Shown {
    std::optional<viewing::SceneMaker> maker{};
    std::uint32_t world = 0;
    std::uint64_t arrivals = 0;
    std::chrono::nanoseconds time{0};
    Clock::time_point at{};
    Clock::time_point due{};
    bool is_playing = false;
    double real_time_factor = 0.0;
  };

  void serve();
  void show_between_turns();
  bool is_due() const;
  void show();
  void show_scene();
  void show_robots();
  void measure_pace(Clock::time_point now);
  void show_status();
  void published();

  const ArraySimulation& simulation_;
  const int process_;
  view::Topics topics_;
  view::ScenePublisher publisher_;
  Shown shown_;
  std::atomic<bool> has_changed_ = false;  // since it was shown

  std::mutex mutex_;  // guards the next one
  bool is_in_turn_ = false;
  std::atomic<bool> is_closed_ = false;
  std::condition_variable closing_;

  std::mutex watched_mutex_;  // guards the next one
  std::vector<std::uint32_t> watched_;

  std::mutex server_mutex_;  // guards the pointer; publishing during a turn does not wait for close
  std::unique_ptr<view::WebServer> server_;
  std::uint16_t port_ = 0;
  std::thread serving_;
  std::thread showing_;
};

}  // namespace cohort::python
