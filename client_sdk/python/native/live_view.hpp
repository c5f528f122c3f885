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

#include "client_sdk/python/native/array_simulation.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tools/view/messages/scene_publisher.hpp"
#include "tools/view/source.hpp"
#include "tools/view/web/web_server.hpp"

namespace cohort::python {

/// A web server of this process that shows a simulation while a program steps it.
///
/// The program takes a turn for everything that may change the simulation. Within a turn the program's thread shows the
/// simulation now and then; between turns, when nothing changes it, a thread of the view shows how the last turn left
/// it. Nothing here needs Python's global lock.
class LiveView final : public view::Source, public std::enable_shared_from_this<LiveView> {
 public:
  /// Listens at 127.0.0.1: at `port`, or without one at 8080, or any free port where that is taken. Shows the
  /// simulation as it is. Throws std::runtime_error if the port is taken. `simulation` must live until this is closed.
  LiveView(const ArraySimulation& simulation, view::PageFiles page, std::optional<std::uint16_t> port);
  ~LiveView() override { close(); }

  std::uint16_t port() const { return port_; }
  bool is_closed() const { return is_closed_; }
  /// Ends the server and frees its port. Any thread, also within a turn. In a process that was forked the view of the
  /// parent goes on. Who owns this calls it before the last owner goes.
  void close();

  /// Begins a turn of the program. Waits while the view reads the simulation.
  void begin_turn();
  /// Notes that the simulation has changed, and shows it if it is time. Within a turn.
  void changed();
  void end_turn();

  void ask(const view::ViewRequest& request, std::function<void(const view::Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;

 private:
  using Clock = std::chrono::steady_clock;

  // What only who may read the simulation uses: the program within its turn, the view between turns.
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

  std::mutex server_mutex_;  // guards the pointer: who publishes within a turn does not wait for who closes
  std::unique_ptr<view::WebServer> server_;
  std::uint16_t port_ = 0;
  std::thread serving_;
  std::thread showing_;
};

}  // namespace cohort::python
