// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/bridge.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>

#include "idl/text/standard_streams.hpp"

namespace cohort::avr {
namespace {

constexpr std::chrono::milliseconds stop_is_asked_every{100};

// Starting threads costs a hundredth of what a core takes for a frame.
template <class Work>
void in_parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> helpers;
  for (std::size_t i = 1; i < threads && i < count; ++i) helpers.emplace_back(take);
  take();
}

// Windows of time in each of which every robot runs once, on any thread. A window ends when all robots have run. So no
// thread waits for one that the system has suspended, unless that one has a robot.
class Windows {
 public:
  Windows(std::size_t robots, std::size_t windows) : robots_(robots), windows_(windows) {}

  // Takes robots until the last window has ended, on several threads at once. `run(robot, window)` runs one, and
  // `end(window)` ends a window; neither throws.
  template <class Run, class End>
  void work(const Run& run, const End& end) {
    std::uint64_t state = state_.load(std::memory_order_acquire);
    while (window_of(state) < windows_) {
      const std::size_t robot = state & most_robots;
      if (robot >= robots_) {
        state = changed_from(state);
      } else if (state_.compare_exchange_weak(state, state + 1, std::memory_order_acq_rel)) {
        run(robot, window_of(state));
        if (ran_.fetch_add(1, std::memory_order_acq_rel) + 1 == robots_) {
          ran_.store(0, std::memory_order_relaxed);
          end(window_of(state));
          state_.store((window_of(state) + 1) << bits_of_robot, std::memory_order_release);
          state_.notify_all();
        }
        state = state_.load(std::memory_order_acquire);
      }
    }
  }

 private:
  static constexpr unsigned bits_of_robot = 32;
  static constexpr std::uint64_t most_robots = 0xffffffff;

  static std::size_t window_of(std::uint64_t state) { return state >> bits_of_robot; }

  // Spins for a while before it sleeps: the others take a few microseconds longer, and sleeping takes more.
  std::uint64_t changed_from(std::uint64_t state) const {
    constexpr int spins = 4000;
    for (int i = 0; i < spins; ++i)
      if (const std::uint64_t now = state_.load(std::memory_order_acquire); now != state) return now;
    state_.wait(state, std::memory_order_acquire);
    return state_.load(std::memory_order_acquire);
  }

  std::size_t robots_, windows_;
  std::atomic<std::uint64_t> state_ = 0;  // the window, and the next robot in it
  std::atomic<std::size_t> ran_ = 0;      // robots in this window
};

template <class Action>
void guard(std::exception_ptr& failure, const Action& action) {
  try {
    action();
  } catch (...) {
    failure = std::current_exception();
  }
}

void tell(const std::string& text) { print_message(text); }

}  // namespace

ClientEnd Bridge::run(const std::atomic<bool>& stop) {
  ClientOptions client_options = options_.client;
  client_options.tell = [](Severity, const std::string& text) { tell(text); };
  Client client(client_options);
  while (!stop) {
    const std::optional<ClientEvent> event = client.next(stop_is_asked_every);
    if (!event) continue;
    if (const auto* ended = std::get_if<ClientEnded>(&*event)) return ended->end;
    try {
      if (const auto* lease = std::get_if<LeaseStart>(&*event)) start(*lease);
      if (const auto* frame = std::get_if<Frame>(&*event)) step(*frame);
      // The memories of microcontrollers are not saved.
      if (const auto* save = std::get_if<SaveState>(&*event)) save->state->leave_out();
    } catch (const std::exception& error) {
      tell(error.what());
      client.fail(error.what());
    }
  }
  tell("interrupted");
  return ClientEnd::interrupted;
}

const Robot::Options& Bridge::options_of(std::size_t place, std::size_t robots) const {
  if (options_.robots.size() == 1) return options_.robots.front();
  if (options_.robots.size() != robots)
    throw std::runtime_error("there are " + std::to_string(options_.robots.size()) + " images for " +
                             std::to_string(robots) + " robots: expected one image, or one for each robot");
  return options_.robots[place];
}

std::shared_ptr<bridges::Link> Bridge::pty_of(const std::string& name) {
  auto& pty = ptys_[name];
  if (!pty) {
    pty = bridges::open_link("pty");
    tell("robot " + name + ": its serial interface is at " + pty->place());
  }
  return pty;
}

void Bridge::start(const LeaseStart& lease) {
  robots_.clear();
  for (std::size_t i = 0; i < lease.robots.size(); ++i) {
    const DrivenRobot& robot = lease.robots[i];
    Robot::Options options = options_of(i, lease.robots.size());
    if (options_.prepare) options_.prepare(options, robot.start);
    std::shared_ptr<bridges::Link> pty;
    if (options.serial_to == SerialTo::pty) pty = pty_of(robot.start.name);
    try {
      robots_[robot.start.robot] = std::make_unique<Robot>(options, options_.make_board(), robot, std::move(pty));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("robot " + robot.start.name + ": " + error.what());
    }
  }
}

void Bridge::step_in_windows(const Frame& frame, std::vector<std::exception_ptr>& failures) {
  const std::size_t count = frame.robots.size();
  if (count == 0) return;
  std::vector<Robot*> robots;
  std::chrono::nanoseconds longest{0};
  for (const FrameRobot& robot : frame.robots) {
    robots.push_back(robots_.at(robot.robot->start.robot).get());
    longest = std::max(longest, robots.back()->period());
  }
  const std::chrono::nanoseconds length = options_.medium->window();
  const auto count_of_windows = static_cast<std::size_t>((longest + length - std::chrono::nanoseconds(1)) / length);
  const auto run = [&](std::size_t i, std::size_t window) {
    const auto its = [&](const auto& action) {
      if (!failures[i]) guard(failures[i], action);
    };
    Robot& robot = *robots[i];
    if (window == 0) its([&] { robot.begin(frame.robots[i], frame.time); });
    if (window == count_of_windows) return its([&] { robot.end(frame.robots[i]); });
    its([&] { robot.run_until(frame.time + std::min(length * static_cast<int>(window + 1), robot.period())); });
  };
  Windows windows(count, count_of_windows + 1);  // the last one is only for ends
  const auto work = [&] {
    windows.work(run, [&](std::size_t window) noexcept {
      if (window < count_of_windows) options_.medium->exchange();
    });
  };
  std::vector<std::jthread> helpers;
  for (std::size_t member = 1; member < options_.threads && member < count; ++member) helpers.emplace_back(work);
  work();
}

void Bridge::step(const Frame& frame) {
  std::vector<std::exception_ptr> failures(frame.robots.size());
  if (options_.medium != nullptr)
    step_in_windows(frame, failures);
  else
    in_parallel(frame.robots.size(), options_.threads, [&](std::size_t i) {
      FrameRobot& robot = frame.robots[i];
      guard(failures[i], [&] { robots_.at(robot.robot->start.robot)->step(robot, frame.time); });
    });
  for (const FrameRobot& robot : frame.robots)
    for (const std::string& line : robots_.at(robot.robot->start.robot)->take_lines())
      tell("robot " + robot.robot->start.name + ": " + line);
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace cohort::avr
