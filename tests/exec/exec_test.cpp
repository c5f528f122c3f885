// SPDX-License-Identifier: Apache-2.0

// `cohort exec` as users have it: a program goes by the time of a run.

#include <gtest/gtest.h>

#include <csignal>
#include <regex>
#include <string>
#include <thread>

#include "tests/support/controlled_run.hpp"

namespace cohort::test {
namespace {

// Returns the output without the line that `cohort exec` prints on a busy machine, where the server is not there at
// once.
std::string without_waiting(const std::string& output) {
  return std::regex_replace(output, std::regex("waiting for a server at [^\n]*\n"), "");
}

constexpr const char* driver = COHORT_BUILD_DIR "/bin/drive_by_the_clock";

std::vector<std::string> exec(const ReservedDomain& domain, const std::vector<std::string>& program,
                              const std::vector<std::string>& options = {}) {
  std::vector<std::string> command = {cohort_program(), "exec", "--domain", domain.text()};
  command.insert(command.end(), options.begin(), options.end());
  command.emplace_back("--");
  command.insert(command.end(), program.begin(), program.end());
  return command;
}

struct Driven {
  std::string state_hash;
  std::string said;
  double seconds = 0.0;
};
Driven drive(const std::vector<std::string>& more, const std::vector<std::string>& of_exec) {
  const FieldOfRobots field(2, 60.0, ", period: 10");
  const ReservedDomain domain;
  std::vector<std::string> options = {"--speed", "max"};
  options.insert(options.end(), more.begin(), more.end());
  Process server(field.serve(domain, options));
  const auto begin = std::chrono::steady_clock::now();
  Process program(exec(domain, {driver}, of_exec));
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  return {field.summary()["state_hash"], without_waiting(program.output()), took.count()};
}

TEST(Exec, AControllerThatGoesByTheClockGivesTheSameBitsTwice) {
  const Driven first = drive({"--threads", "1"}, {});
  const Driven second = drive({"--threads", "2"}, {"--period", "10"});
  EXPECT_NE(first.said.find("600 frames, hash of their times "), std::string::npos) << first.said;
  EXPECT_EQ(first.said, second.said);
  EXPECT_EQ(first.state_hash, second.state_hash);
  std::printf("60 s of a controller of 10 Hz: %.2f s and %.2f s\n", first.seconds, second.seconds);
}

TEST(Exec, TheRunGoesOnWhenAProgramThatHeldItsTimeIsKilled) {
  const FieldOfRobots field(2, 2.0);
  ControlledRun run(field, {}, false);
  Process program(exec(run.domain(), {"sh", "-c", "while :; do sleep 0.1; done"}));
  ASSERT_TRUE(eventually([&] { return run.server().output().find("AdvanceTime") != std::string::npos; }))
      << run.server().output();
  ::kill(program.pid(), SIGKILL);
  run.attach();
  const nlohmann::json summary = run.finish();
  ASSERT_EQ(events_of(summary, "time").size(), 1u) << summary["events"];
  EXPECT_NE(events_of(summary, "time")[0]["text"].get<std::string>().find("cohort exec sh"), std::string::npos);
  EXPECT_EQ(summary["state_hash"], reference(field));
}

TEST(Exec, LeavesTheRunItsBitsAndEndsWithItsProgram) {
  const FieldOfRobots field(2, 2.0);
  ControlledRun run(field, {}, false);
  Process program(exec(run.domain(), {"sh", "-c", "sleep 1; exit 7"}));
  ASSERT_TRUE(eventually([&] { return run.server().output().find("AdvanceTime") != std::string::npos; }));
  run.attach();
  EXPECT_EQ(program.wait_for_exit(), 7) << program.output();
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
}

TEST(Exec, SaysThatTheRunHadBegunBeforeItsProgram) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field);
  ASSERT_TRUE(run.comes_to([](const nlohmann::json& status) { return status["tick"] > 100; }));
  Process program(exec(run.domain(), {"true"}));
  EXPECT_EQ(program.wait_for_exit(), 0);
  EXPECT_NE(program.output().find("warning: the run was already at "), std::string::npos) << program.output();
  EXPECT_NE(program.output().find(" s when 'true' began."), std::string::npos) << program.output();
  run.ctl({"quit"});
}

TEST(Exec, WritesAFileOnceItHoldsTheRunsFirstTick) {
  const FieldOfRobots field(2, 2.0);
  const ScratchFolder folder;
  const std::string ready = (folder / "ready").string();
  ControlledRun run(field, {}, false);
  Process program(
      exec(run.domain(), {"python3", "-c", "import time; print('begins at', time.monotonic())"}, {"--ready", ready}));
  ASSERT_TRUE(eventually([&] { return read_file(ready) == "holds the run at tick 0\n"; })) << program.output();
  run.attach();
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  EXPECT_EQ(without_waiting(program.output()), "begins at 0.0\n");
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
}

TEST(Exec, EndsAProgramWhoseRunIsOver) {
  const FieldOfRobots field(2, 1.0);
  ControlledRun run(field, {}, false);
  Process program(exec(run.domain(), {"sh", "-c", "sleep 100"}));
  ASSERT_TRUE(eventually([&] { return run.server().output().find("AdvanceTime") != std::string::npos; }));
  run.attach();
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  EXPECT_NE(program.output().find("the run has ended; 'sh' was terminated"), std::string::npos) << program.output();
  run.finish();
}

TEST(Exec, TheProgramsClockGoesOnThroughAReset) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {}, false);
  Process program(exec(run.domain(), {"python3", "-uc",
                                      "import time\n"
                                      "last = time.monotonic()\n"
                                      "while True:\n"
                                      "    time.sleep(0.05)\n"
                                      "    now = time.monotonic()\n"
                                      "    assert 0.0499 < now - last < 0.0701, (last, now)\n"
                                      "    last = now\n"}));
  ASSERT_TRUE(eventually([&] { return run.server().output().find("AdvanceTime") != std::string::npos; }));
  run.attach();
  Control control = control_of(run);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(eventually([&] { return control.status().tick > 100; }));
    control.reset();
  }
  ASSERT_TRUE(eventually([&] { return control.status().tick > 100; })) << program.output();
  EXPECT_TRUE(program.running()) << program.output();
  control.quit();
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  run.finish();
}

TEST(Exec, RunsAClientOnFastDds) {
  const std::string client = COHORT_BUILD_DIR "/bin/fastdds_client";
  if (!std::filesystem::exists(client)) GTEST_SKIP() << "there is no Fast DDS: tools/dev/packages-conformance.txt";
  const FieldOfRobots field(2, 5.0);
  ControlledRun run(field, {}, false);
  Process program(exec(run.domain(), {client, COHORT_BUILD_DIR "/lib/controllers/obstacle_avoidance.so",
                                      run.domain().text(), "all", "0"}));
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  EXPECT_NE(program.output().find("answered in all 500"), std::string::npos) << program.output();
}

TEST(Exec, SaysWhatIsWrongWithAProgram) {
  const FieldOfRobots field(1, 1e4);
  ControlledRun run(field, {"--paused"}, false);
  const Ended ended = run_to_end(exec(run.domain(), {"no-such-program"}));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(without_waiting(ended.err), "cohort: error: no program 'no-such-program' in $PATH\n");
  run.ctl({"quit"});
}

// As docs/protocol.md says of AdvanceTime.
TEST(HeldTime, ARunLeavesATickOnlyWhenAllWhoHoldItsTimeHaveAskedForALaterOne) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field);
  Control one = control_of(run);
  Control other = control_of(run);
  const auto refusal = [](const std::function<void()>& request) {
    try {
      request();
    } catch (const ControlError& error) {
      return error.result;
    }
    return ControlResult::bad_reply;
  };
  EXPECT_EQ(refusal([&] { one.advance_time(); }), ControlResult::time_not_held) << "it does not hold the time";
  EXPECT_EQ(refusal([&] { one.advance_time(0); }), ControlResult::malformed);
  EXPECT_EQ(refusal([&] { one.advance_time(~std::uint64_t{0}); }), ControlResult::malformed);
  one.hold_time();
  const std::uint64_t begin = one.advance_time().tick;
  other.hold_time();
  EXPECT_EQ(other.advance_time().tick, begin) << "the first is where the run stands";
  std::thread ahead([&] { EXPECT_EQ(other.advance_time(10).tick, begin + 10); });
  for (std::uint64_t tick = begin + 1; tick <= begin + 10; ++tick) EXPECT_EQ(one.advance_time().tick, tick);
  ahead.join();
  EXPECT_EQ(one.status().tick, begin + 10);
  // Before, the run waits for the answers of its robots.
  EXPECT_TRUE(eventually([&] {
    const auto awaited = one.status().awaited;
    return awaited.size() == 1 && awaited[0].starts_with("the client that holds the time");
  }));
  other.release_time();
  EXPECT_EQ(one.advance_time(5).tick, begin + 15);
  one.reset();
  EXPECT_EQ(one.advance_time(1000).tick, 0u) << "in another run";
  EXPECT_EQ(one.advance_time(2).tick, 2u);
  one.release_time();
  EXPECT_TRUE(eventually([&] { return one.status().tick > 100; }));
  one.quit();
  run.finish();
}

}  // namespace
}  // namespace cohort::test
