// SPDX-License-Identifier: Apache-2.0

// A controller with a loop of its own that goes by the clock, ten times a second, as programs for real robots do: it
// takes the newest observations, and commands. Prints a hash of the times at which it did.
//
// The server is that of the environment; it drives all robots, to the end of the run.

#include <chrono>
#include <cohort/client.hpp>
#include <cstdio>
#include <thread>

namespace {

using namespace std::chrono_literals;

class Driver {
 public:
  explicit Driver(const cohort::ClientOptions& options) : client_(options) {}

  // Takes and answers what comes within the time, at least one frame if `until_a_frame`. False once the run has ended.
  bool drive(std::chrono::milliseconds at_most, bool until_a_frame) {
    while (auto event = client_.next(at_most)) {
      if (std::get_if<cohort::ClientEnded>(&*event)) return false;
      auto* const frame = std::get_if<cohort::Frame>(&*event);
      if (frame == nullptr) continue;
      command(*frame);
      if (until_a_frame) return true;
    }
    return true;
  }

  int frames() const { return frames_; }
  unsigned long long hash() const { return hash_; }

 private:
  void command(cohort::Frame& frame) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    hash_ = (hash_ ^ static_cast<std::uint64_t>(now)) * 1099511628211U;
    ++frames_;
    const double turn = 1e-3 * static_cast<double>(now / 1'000'000 % 77);
    for (cohort::FrameRobot& robot : frame.robots) {
      robot.command.set(robot.robot->start.command("treel/left/velocity"), 0.1 + turn);
      robot.command.set(robot.robot->start.command("treel/right/velocity"), 0.1 - turn);
    }
    client_.answer();
  }

  cohort::Client client_;
  int frames_ = 0;
  std::uint64_t hash_ = 1469598103934665603U;
};

}  // namespace

int main() {
  cohort::ClientOptions options;
  options.name = "drive_by_the_clock";
  cohort::take_environment(options);
  Driver driver(options);
  if (!driver.drive(1h, true)) return 1;  // the run has begun
  const auto begin = std::chrono::steady_clock::now();
  for (int cycle = 1;; ++cycle) {
    std::this_thread::sleep_until(begin + cycle * 100ms);
    if (!driver.drive(0ms, false)) break;
  }
  std::printf("%d frames, hash of their times %016llx\n", driver.frames(), driver.hash());
  return 0;
}
