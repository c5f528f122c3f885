// SPDX-License-Identifier: Apache-2.0

// Programs that a bridge starts in virtual time, with the option --run.

#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <regex>
#include <sstream>

#include "tests/bridges/epuck2_program.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// One robot in an empty world, unless an experiment is given, and a bridge that runs a course of
// epuck2_by_the_clock.py.
class RunByBridge {
 public:
  struct Options {
    std::string command;
    std::string seconds = "2";
    std::string threads = "1";
    std::vector<std::string> more{};  // options of the bridge
    std::string experiment{};
    std::string robots = "epuck";
  };
  explicit RunByBridge(const Options& options) : begin_(std::chrono::steady_clock::now()) {
    write_file(folder_ / "world.yaml",
               "world:\n  name: room\n"
               "  model: {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
               "  include: {uri: model://epuck2, name: epuck}\n");
    write_file(folder_ / "experiment.yaml",
               "world: world.yaml\nduration: 1\nseed: 1\nphysics: {fidelity: articulated}\n"
               "teams:\n  - {name: alone, robots: epuck, controller: constant, period: 5}\n");
    const std::string experiment =
        options.experiment.empty() ? (folder_ / "experiment.yaml").string() : options.experiment;
    server_ = std::make_unique<Process>(std::vector<std::string>{
        cohort_program(), "serve", experiment, "--duration", options.seconds, "--threads", options.threads, "--domain",
        domain_.text(), "--summary", (folder_ / "summary.json").string()});
    std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/cohort-epuck2-bridge",
                                        "--robots",
                                        options.robots,
                                        "--domain",
                                        domain_.text(),
                                        "--port",
                                        "0",
                                        "--run",
                                        options.command + " > " + (folder_ / "$COHORT_ROBOT.txt").string()};
    command.insert(command.end(), options.more.begin(), options.more.end());
    bridge_ = std::make_unique<Process>(command);
  }

  Process& bridge() { return *bridge_; }
  void ctl(const std::string& request) const {
    const Ended ended = run_to_end({cohort_program(), "ctl", "--domain", domain_.text(), request});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
  }
  std::uint16_t port() {
    EXPECT_TRUE(bridge_->wait_for_output(" at 127.0.0.1:")) << bridge_->output();
    std::smatch match;
    const std::string output = bridge_->output();
    if (!std::regex_search(output, match, std::regex(R"( at [\d.]+:(\d+)\n)"))) return 0;
    return static_cast<std::uint16_t>(std::stoul(match[1]));
  }
  std::string written(const std::string& robot = "epuck") const { return read_file(folder_ / (robot + ".txt")); }
  std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream text(written());
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }

  nlohmann::json summary() {
    EXPECT_EQ(server_->wait_for_exit(), 0) << server_->output();
    EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
    return read_json(folder_ / "summary.json");
  }
  std::string state_hash() { return summary()["state_hash"]; }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_;
  ReservedDomain domain_;
  ScratchFolder folder_;
  std::unique_ptr<Process> server_;
  std::unique_ptr<Process> bridge_;
};

// The system's Python itself: another one may be a script that starts it.
std::string course(const std::string& name) {
  return "exec /usr/bin/python3 " COHORT_SOURCE_DIR "/tests/bridges/epuck2_by_the_clock.py " + name;
}

TEST(RunByBridge, ProgramsThatGoByTheClockGiveTheSameBitsWithAnyThreadsOfTheServer) {
  std::vector<std::string> hashes, stamps;
  for (const char* threads : {"1", "2"}) {
    RunByBridge run({.command = course("avoid_obstacles"),
                     .seconds = "60",
                     .threads = threads,
                     .experiment = COHORT_SOURCE_DIR "/worlds/experiments/epuck2.yaml",
                     .robots = "0..3"});
    const auto summary = run.summary();
    std::printf("60 s of four programs of 10 Hz: %.2f s\n", run.seconds());
    EXPECT_EQ(summary["ticks"], 6000);
    hashes.push_back(summary["state_hash"]);
    stamps.push_back(run.written("0") + run.written("1") + run.written("2") + run.written("3"));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(stamps[0], stamps[1]);
  // An exchange takes a period of 50 ms, and 50 ms are slept after it.
  EXPECT_TRUE(stamps[0].starts_with("0.050000000 25 25\n0.150000000 75 75\n0.250000000 125 125\n")) << stamps[0];
}

TEST(RunByBridge, AProgramThatIsSilentKeepsItsLastCommand) {
  RunByBridge always({.command = course("speak_always")});
  const std::string hash = always.state_hash();
  EXPECT_EQ(always.lines().size(), 39U);
  for (const char* policy : {"wait", "stand"}) {
    RunByBridge once({.command = course("speak_once"), .more = {"--without-program", policy}});
    EXPECT_EQ(once.state_hash(), hash) << policy;
    EXPECT_EQ(once.lines().size(), 1U);
  }
}

TEST(RunByBridge, ASleepTakesWhatItAsksForAndTheRobotDrivesOn) {
  RunByBridge run({.command = course("command_after_a_second")});
  run.summary();
  ASSERT_GT(run.lines().size(), 2U);
  EXPECT_EQ(run.lines()[0], "0.050000000 15 10");
  EXPECT_TRUE(run.lines()[1].starts_with("1.100000000 3")) << run.lines()[1];
  EXPECT_EQ(run.lines()[2].substr(12), run.lines().back().substr(12)) << "it stands from then on";
}

TEST(RunByBridge, AProgramThatEndsIsNamedWithItsExitCode) {
  RunByBridge run({.command = course("leave"), .more = {"--without-program", "stand"}});
  EXPECT_EQ(run.summary()["ticks"], 200);
  EXPECT_TRUE(run.bridge().wait_for_output("leave > ")) << run.bridge().output();
  EXPECT_NE(run.bridge().output().find("' has ended with the exit code 3: the robot stands"), std::string::npos)
      << run.bridge().output();
}

TEST(RunByBridge, OrTheRunWaitsForAnotherOne) {
  RunByBridge run({.command = course("leave")});
  EXPECT_TRUE(
      run.bridge().wait_for_output("' has ended with the exit code 3: the run waits until a program connects again"))
      << run.bridge().output();
  EpuckProgram program(run.port());
  for (;;) {
    program.send(EpuckProgram::command(0, 0));
    if (program.receive(1).empty()) break;
    program.receive(104);
  }
  EXPECT_EQ(run.summary()["ticks"], 200);
}

TEST(RunByBridge, ACommandThatTheShellDoesNotFindIsNamed) {
  RunByBridge run({.command = "no-such-program", .more = {"--without-program", "stand"}});
  EXPECT_EQ(run.summary()["ticks"], 200);
  EXPECT_NE(run.bridge().output().find("has ended with the exit code 127"), std::string::npos) << run.bridge().output();
}

TEST(RunByBridge, AProgramMayLeaveAndConnectAgain) {
  for (const char* policy : {"wait", "stand"}) {
    std::vector<std::string> hashes, stamps;
    for (int i = 0; i < 2; ++i) {
      RunByBridge run({.command = course("reconnect"), .more = {"--without-program", policy}});
      hashes.push_back(run.state_hash());
      stamps.push_back(run.written());
      EXPECT_GT(run.lines().size(), 8U);
    }
    EXPECT_EQ(hashes[0], hashes[1]) << policy;
    EXPECT_EQ(stamps[0], stamps[1]) << policy;
  }
}

TEST(RunByBridge, NonsenseAndAnswersThatAreNotReadDoNotStopTheRun) {
  RunByBridge nonsense({.command = course("speak_nonsense")});
  EXPECT_EQ(nonsense.summary()["ticks"], 200);
  EXPECT_NE(nonsense.bridge().output().find("a command begins with 0x80"), std::string::npos);
  RunByBridge unread({.command = course("never_read"), .seconds = "30"});
  EXPECT_EQ(unread.summary()["ticks"], 3000);
}

TEST(RunByBridge, TheProgramsClockGoesOnThroughAReset) {
  RunByBridge run({.command = course("speak_always"), .seconds = "1e4"});
  ASSERT_TRUE(run.bridge().wait_for_output("has connected")) << run.bridge().output();
  for (int i = 0; i < 3; ++i) {
    const std::size_t before = run.lines().size();
    ASSERT_TRUE(eventually([&] { return run.lines().size() > before + 20; }));
    run.ctl("reset");
  }
  run.ctl("shutdown");
  run.summary();
  double last = 0.0;
  for (const std::string& line : run.lines()) {
    const double now = std::stod(line);
    EXPECT_GE(now, last);
    EXPECT_LT(now, last + 0.1001);
    last = now;
  }
}

TEST(RunByBridge, AProgramThatNeverWaitsIsNamedAndEndsWithTheBridge) {
  RunByBridge run({.command = course("spin")});
  EXPECT_TRUE(run.bridge().wait_for_output("spin > ")) << run.bridge().output();
  EXPECT_NE(run.bridge().output().find("has not waited for anything for 5 s, so simulated time does not advance"),
            std::string::npos)
      << run.bridge().output();
  run.bridge().signal(SIGTERM);
  EXPECT_EQ(run.bridge().wait_for_exit(), 130) << run.bridge().output();
}

}  // namespace
}  // namespace cohort::test
