// SPDX-License-Identifier: Apache-2.0
#include "tools/python/native/live_view.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/view/messages/view_messages.hpp"

namespace cohort::python {
namespace {

using Seconds = std::chrono::duration<double>;
using std::chrono::nanoseconds;

constexpr std::uint16_t usual_port = 8080;
constexpr std::chrono::microseconds frame_interval{33'334};  // at most 30 frames a second
constexpr int least_rest = 19;                               // frames take at most a twentieth of the time
constexpr std::chrono::milliseconds until_paused{500};

// Notebooks on this machine embed the page in a frame. Viewers cannot change anything here.
constexpr const char* pages_of_this_machine = "http://127.0.0.1:* http://localhost:*";

view::WebOptions options_for(const std::string& name, std::optional<std::uint16_t> port) {
  return {.name = name,
          .port = port.value_or(usual_port),
          .or_any_free_port = !port.has_value(),
          .frame_ancestors = pages_of_this_machine};
}

}  // namespace

LiveView::LiveView(const ArraySimulation& simulation, view::PageFiles page, std::optional<std::uint16_t> port)
    : simulation_(simulation),
      process_(::getpid()),
      topics_([this] { published(); }),
      publisher_(topics_),
      server_(
          std::make_unique<view::WebServer>(options_for(simulation.experiment().name, port), std::move(page), topics_)),
      port_(server_->port()) {
  publisher_.publish(view::Topic::events, view::ViewEvents{}, nanoseconds(0));
  show();
  serving_ = std::thread([this, &server = *server_] {
    try {
      server.run(*this);
    } catch (const std::exception&) {
      // The pages lose their connection; the program continues.
    }
  });
  showing_ = std::thread([this] {
    try {
      show_between_turns();
    } catch (const std::exception&) {
      // As above: not enough memory for a frame.
    }
  });
}

void LiveView::close() {
  if (process_ != ::getpid()) {
    // The threads belong to the parent, and their locks stay locked here: so this is never destroyed.
    if (!is_closed_.exchange(true)) static_cast<void>(new std::shared_ptr<LiveView>(shared_from_this()));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (is_closed_.exchange(true)) return;
  }
  closing_.notify_all();
  std::unique_ptr<view::WebServer> server;
  {
    const std::lock_guard lock(server_mutex_);
    server = std::move(server_);
  }
  server->stop();
  serving_.join();
  showing_.join();
}

void LiveView::published() {
  const std::lock_guard lock(server_mutex_);
  if (server_ != nullptr) server_->published();
}

void LiveView::begin_turn() {
  const std::lock_guard lock(mutex_);
  is_in_turn_ = true;
}

void LiveView::changed() {
  has_changed_ = true;
  if (!is_closed_ && is_due()) show();
}

void LiveView::end_turn() {
  const std::lock_guard lock(mutex_);
  has_changed_ = true;
  is_in_turn_ = false;
}

void LiveView::show_between_turns() {
  std::unique_lock lock(mutex_);
  while (!closing_.wait_for(lock, frame_interval, [this] { return is_closed_.load(); })) {
    if (is_in_turn_) continue;
    if (is_due()) {
      show();
    } else if (shown_.is_playing && Clock::now() - shown_.at > until_paused) {
      shown_.is_playing = false;
      show_status();
    }
  }
}

bool LiveView::is_due() const {
  return topics_.is_read() && (has_changed_ || topics_.arrivals() != shown_.arrivals) && Clock::now() >= shown_.due;
}

void LiveView::show() {
  const Simulation& simulation = simulation_.simulation();
  shown_.arrivals = topics_.arrivals();
  has_changed_ = false;
  if (!shown_.maker || shown_.world != simulation_.world_number() || shown_.maker->is_outdated()) show_scene();
  const Clock::time_point begin = Clock::now();
  publisher_.show(shown_.maker->frame(shown_.world, simulation.state_hash()), simulation.time());
  publisher_.show(shown_.maker->signals(), simulation.time());
  if (publisher_.is_read(view::Topic::contacts))
    publisher_.publish(view::Topic::contacts, shown_.maker->contacts(), simulation.time());
  if (publisher_.is_read(view::Topic::robots)) show_robots();
  measure_pace(begin);
  show_status();
  const Clock::time_point end = Clock::now();
  shown_.due = std::max<Clock::time_point>(begin + frame_interval, end + least_rest * (end - begin));
}

void LiveView::show_scene() {
  const Simulation& simulation = simulation_.simulation();
  const std::uint32_t revision = publisher_.show(viewing::SceneMaker(simulation, 0).scene(), simulation.time());
  shown_.maker.emplace(simulation, revision);
  shown_.world = simulation_.world_number();
}

void LiveView::show_robots() {
  const Simulation& simulation = simulation_.simulation();
  messages::SceneRobots robots;
  {
    const std::lock_guard lock(watched_mutex_);
    for (const std::uint32_t robot : watched_)
      if (robot < simulation.robot_count()) robots.robots.push_back(shown_.maker->robot(robot));
  }
  publisher_.publish(view::Topic::robots, robots, simulation.time());
}

void LiveView::measure_pace(Clock::time_point now) {
  constexpr double smoothing = 0.1;
  const double simulated = Seconds(simulation_.simulation().time() - shown_.time).count();
  const double wall = Seconds(now - shown_.at).count();
  const bool was_playing = std::exchange(shown_.is_playing, simulated > 0.0);
  const double pace = wall > 0.0 ? std::max(0.0, simulated / wall) : 0.0;
  shown_.real_time_factor = was_playing ? std::lerp(shown_.real_time_factor, pace, smoothing) : pace;
  shown_.time = simulation_.simulation().time();
  shown_.at = now;
}

void LiveView::show_status() {
  view::ViewStatus status;
  status.source = "program";
  status.name = simulation_.experiment().name;
  status.is_playing = shown_.is_playing;
  status.speed = 0.0;
  status.real_time_factor = shown_.is_playing ? shown_.real_time_factor : 0.0;
  status.time_ns = shown_.time.count();
  status.end_ns = std::max(shown_.time, simulation_.experiment().duration).count();
  publisher_.publish(view::Topic::status, status, shown_.time);
}

void LiveView::ask(const view::ViewRequest& request, std::function<void(const view::Answer&)> answer) {
  answer({false, "'" + request.operation +
                     "' is not available to viewers: the Python program that steps this world also "
                     "plays, pauses and changes it"});
}

void LiveView::watch(const std::vector<std::uint32_t>& robots) {
  {
    const std::lock_guard lock(watched_mutex_);
    watched_ = robots;
  }
  has_changed_ = true;
}

}  // namespace cohort::python
