#include "tools/bridges/avr/bridge.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>

#include "client_sdk/src/standard_streams.hpp"

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

// A barrier whose threads spin for a while before they sleep: the others are a few microseconds late, and sleeping
// takes longer. Where there are fewer cores than threads they do sleep.
class SpinBarrier {
 public:
  explicit SpinBarrier(unsigned threads) : threads_(threads) {}

  // Returns when all threads have arrived; the last one calls `completion` first.
  template <class Completion>
  void arrive_and_wait(const Completion& completion) {
    constexpr int spins = 4000;
    const unsigned phase = phase_.load(std::memory_order_acquire);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      arrived_.store(0, std::memory_order_relaxed);
      completion();
      phase_.store(phase + 1, std::memory_order_release);
      phase_.notify_all();
      return;
    }
    for (int i = 0; i < spins; ++i)
      if (phase_.load(std::memory_order_acquire) != phase) return;
    phase_.wait(phase, std::memory_order_acquire);
  }

 private:
  unsigned threads_;
  std::atomic<unsigned> arrived_ = 0, phase_ = 0;
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

// Each thread has robots of its own for the whole frame, and waits for the others after each window.
void Bridge::step_in_windows(const Frame& frame, std::vector<std::exception_ptr>& failures) {
  const std::size_t count = frame.robots.size();
  std::vector<Robot*> robots;
  std::chrono::nanoseconds end = frame.time;
  for (const FrameRobot& robot : frame.robots) {
    robots.push_back(robots_.at(robot.robot->start.robot).get());
    end = std::max(end, frame.time + robots.back()->period());
  }
  const std::size_t team = std::clamp<std::size_t>(count, 1, options_.threads);
  SpinBarrier barrier(static_cast<unsigned>(team));
  const auto work = [&](std::size_t member) {
    const auto each = [&](const auto& action) {
      for (std::size_t i = member; i < count; i += team)
        if (!failures[i]) guard(failures[i], [&] { action(*robots[i], frame.robots[i]); });
    };
    each([&](Robot& robot, FrameRobot& its) { robot.begin(its, frame.time); });
    for (std::chrono::nanoseconds time = frame.time; time < end;) {
      time = std::min(time + options_.medium->window(), end);
      each([&](Robot& robot, FrameRobot&) { robot.run_until(std::min(time, frame.time + robot.period())); });
      barrier.arrive_and_wait([this]() noexcept { options_.medium->exchange(); });
    }
    each([](Robot& robot, FrameRobot& its) { robot.end(its); });
  };
  std::vector<std::jthread> helpers;
  for (std::size_t member = 1; member < team; ++member) helpers.emplace_back(work, member);
  work(0);
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
