// SPDX-License-Identifier: Apache-2.0

// Prints a table of the cost of robots that ROS 2 nodes observe.
//   ros2_benchmark [--robots N] [--seconds S]
//
// Robots like the TurtleBot3 stand on a plane. Each publishes scan (360 rays), odom, imu and tf at 20 Hz through
// cohort-ros2-bridge, which has one core. One process subscribes to all of it. The run is in real time. For comparison,
// the table has the cost of recording the same observations. A separate network namespace keeps other machines out.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <ctime>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>

#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/ros_messages.hpp"
#include "tests/ros2/own_network.hpp"
#include "tests/support/process.hpp"

namespace cohort {
namespace {

namespace ros = messages::ros;
constexpr int rate = 20;  // [Hz]
constexpr std::array topics = {std::pair{"scan", "sensor_msgs/msg/LaserScan"},
                               std::pair{"odom", "nav_msgs/msg/Odometry"}, std::pair{"imu", "sensor_msgs/msg/Imu"},
                               std::pair{"tf", "tf2_msgs/msg/TFMessage"}};
const std::string programs = COHORT_BUILD_DIR "/bin/";

double to_seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double cpu_seconds(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0)
    throw std::runtime_error("a program has ended too early");
  return to_seconds(time);
}
// Returns the CPU time of child processes that have ended.
double cpu_seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// Writes the experiment, whose sensors measure at `rate`. Returns the path of its file.
std::string write_experiment(const test::ScratchFolder& folder, int robots) {
  const std::string source = COHORT_SOURCE_DIR "/worlds/robots/turtlebot3/";
  std::string model = test::read_file(source + "model.sdf");
  for (const char* its_rate : {"5", "100"})
    model =
        replaced(model, std::string("<update_rate>") + its_rate + "<", "<update_rate>" + std::to_string(rate) + "<");
  std::filesystem::create_directory(folder / "turtlebot3");
  test::write_file(folder / "turtlebot3/model.sdf", model);
  std::filesystem::copy_file(source + "model.config", folder / "turtlebot3/model.config");
  std::string world =
      "world:\n  name: plane\n  model:\n    - name: ground\n      static: true\n      link: {name: body, collision: "
      "{name: floor, geometry: {plane: {normal: [0, 0, 1], size: [100, 100]}}}}\n  include:\n";
  const int side = static_cast<int>(std::ceil(std::sqrt(robots)));
  for (int i = 0; i < robots; ++i)
    world += "    - {uri: turtlebot3, name: robot_" + std::to_string(i) + ", pose: [" + std::to_string(i % side) +
             ", " + std::to_string(i / side) + ", 0, 0, 0, 0]}\n";
  test::write_file(folder / "world.yaml", world);
  test::write_file(folder / "experiment.yaml",
                   "world: world.yaml\nduration: 1000\nseed: 1\nteams:\n  - name: robots\n    robots: all\n"
                   "    controller: constant\n    period: 5\n    parameters: {drive/0/linear: 0.1, "
                   "drive/0/angular: 0.5}\nros2:\n  base_frame: base_footprint\n");
  return folder / "experiment.yaml";
}

// Subscribes to everything and counts what it receives.
class Subscriber {
 public:
  explicit Subscriber(int robots) : participant_(options()) {
    const auto count = [this](const ros2::Received& received) {
      const std::scoped_lock lock(mutex_);
      ++messages_;
      bytes_ += received.bytes.size();
    };
    for (int i = 0; i < robots; ++i)
      for (const auto& [name, type] : topics)
        readers_.emplace_back(participant_, ros2::topic_endpoint("/robot_" + std::to_string(i) + "/" + name, type, ""),
                              count);
    readers_.emplace_back(participant_, ros2::topic_endpoint("/clock", ros::Clock::type, ""),
                          [this](const ros2::Received& received) {
                            const auto clock = messages::decode<ros::Clock>(received.bytes).clock;
                            const std::scoped_lock lock(mutex_);
                            time_ = clock.sec + 1e-9 * clock.nanosec;
                            has_ticked_.notify_all();
                          });
  }

  struct Seen {
    double time = 0.0;  // simulated
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;
  };
  // Waits until every reader has a writer.
  void wait_for_writers() {
    if (!test::eventually(
            [&] { return std::ranges::all_of(readers_, [](const auto& each) { return each.writers() == 1; }); }))
      throw std::runtime_error("the bridge does not publish everything");
  }
  // Waits for the first tick at `time` or later.
  Seen wait_until(double time) {
    std::unique_lock lock(mutex_);
    if (!has_ticked_.wait_for(lock, std::chrono::minutes(5), [&] { return time_ >= time; }))
      throw std::runtime_error("the run does not go on");
    return {time_, messages_, bytes_};
  }
  double time() {
    const std::scoped_lock lock(mutex_);
    return time_;
  }

 private:
  static ros2::RosParticipant::Options options() {
    ros2::RosParticipant::Options made;
    made.name = "subscriber";
    return made;
  }

  std::mutex mutex_;
  std::condition_variable has_ticked_;
  double time_ = -1.0;
  std::uint64_t messages_ = 0;
  std::uint64_t bytes_ = 0;
  ros2::RosParticipant participant_;
  std::vector<ros2::RosReader> readers_;
};

void measure_bridge(const std::string& experiment, int robots, double seconds) {
  Subscriber subscriber(robots);
  const test::Process server({programs + "cohort", "serve", experiment, "--domain", "1", "--speed", "1"});
  const test::Process bridge({"/usr/bin/taskset", "--cpu-list", "0", programs + "cohort-ros2-bridge", "--domain", "1"});
  const auto started = std::chrono::steady_clock::now();
  subscriber.wait_for_writers();
  std::printf("all endpoints have found each other after %.2f s, %.2f s of the bridge's CPU\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count(),
              cpu_seconds(bridge.pid()));
  const Subscriber::Seen begin = subscriber.wait_until(subscriber.time() + 1.0);
  const auto since = std::chrono::steady_clock::now();
  const double bridge_begin = cpu_seconds(bridge.pid()), own_begin = cpu_seconds(getpid());
  const Subscriber::Seen end = subscriber.wait_until(begin.time + seconds);
  const double bridge_cpu = cpu_seconds(bridge.pid()) - bridge_begin, own_cpu = cpu_seconds(getpid()) - own_begin;
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  const double simulated = end.time - begin.time, frames = simulated * rate * robots;
  const auto count = static_cast<double>(end.messages - begin.messages);
  std::printf("bridge, one core: %.1f us CPU a robot and frame, %.0f %% of the core, %.2f x real time\n",
              1e6 * bridge_cpu / frames, 100.0 * bridge_cpu / wall, simulated / wall);
  std::printf("  %.0f messages a second, %.1f MB/s; %.2f %% of what was due came to the subscriber\n", count / wall,
              1e-6 * static_cast<double>(end.bytes - begin.bytes) / wall,
              100.0 * count / (frames * static_cast<double>(topics.size())));
  std::printf("subscriber: %.1f us CPU a robot and frame\n", 1e6 * own_cpu / frames);
}

// Returns the CPU time of a run with additional arguments.
double cpu_seconds_of_run(const std::string& experiment, double seconds, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {
      programs + "cohort", "run",       experiment,  "--duration", std::to_string(seconds),
      "--controllers",     "inprocess", "--threads", "1"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const double before = cpu_seconds_of_children();
  const test::Ended ended = test::run_to_end(command);
  if (ended.exit_code != 0) throw std::runtime_error(ended.err);
  return cpu_seconds_of_children() - before;
}

void measure_recorder(const test::ScratchFolder& folder, const std::string& experiment, int robots, double seconds) {
  const double alone = cpu_seconds_of_run(experiment, seconds, {});
  const double recorded = cpu_seconds_of_run(
      experiment, seconds,
      {"--record", folder / "run.mcap", "--record-observations", std::to_string(rate), "--record-poses", "0"});
  std::printf("recorder: %.1f us CPU a robot and frame; the run itself: %.1f us\n",
              1e6 * (recorded - alone) / (seconds * rate * robots), 1e6 * alone / (seconds * rate * robots));
}

}  // namespace
}  // namespace cohort

int main(int argc, char** argv) {
  int robots = 100;
  double seconds = 10.0;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (argv[i] == std::string("--robots")) robots = std::max(1, std::atoi(argv[i + 1]));
    if (argv[i] == std::string("--seconds")) seconds = std::max(0.1, std::atof(argv[i + 1]));
  }
  if (!cohort::test::has_own_network()) {
    std::fprintf(stderr, "no network namespaces here\n");
    return 77;
  }
  try {
    const cohort::test::ScratchFolder folder;
    const std::string experiment = cohort::write_experiment(folder, robots);
    std::printf("%d robots at %d Hz for %.1f s\n", robots, cohort::rate, seconds);
    cohort::measure_bridge(experiment, robots, seconds);
    cohort::measure_recorder(folder, experiment, robots, seconds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
