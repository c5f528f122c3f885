// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/controlled_run.hpp"

// `cohort record`: another process records a running run.
namespace cohort::test {
namespace {

class LiveRecordings : public ::testing::Test {
 protected:
  std::string operator/(const std::string& name) const { return folder_ / name; }
  std::vector<std::string> record(const ControlledRun& run, const std::string& name,
                                  const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {cohort_program(),    "record", "--domain",
                                        run.domain().text(), "-o",     *this / name};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  std::string verify(const std::string& name) const {
    const Ended replayed = run_to_end({cohort_program(), "replay", *this / name, "--verify"});
    return replayed.out + replayed.err;
  }

 private:
  ScratchFolder folder_;
};

TEST_F(LiveRecordings, ContainTheRunFromTheirStartAndDoNotChangeIt) {
  const FieldOfRobots field(4, 8.0);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "100"});
  Process recording(record(run, "run.mcap", {"--poses", "20", "--observations", "10", "--robots", "swarm/sbot_1"}));
  ASSERT_TRUE(recording.wait_for_output("recorded from tick 100 on")) << recording.output();
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
  EXPECT_EQ(recording.wait_for_exit(), 0) << recording.output();
  EXPECT_NE(recording.output().find("to the end of the run"), std::string::npos) << recording.output();
  EXPECT_EQ(verify("run.mcap"), "identical, 701 ticks\n");
  ASSERT_EQ(run_to_end({cohort_program(), "export-data", *this / "run.mcap", "--csv", *this / "tables"}).exit_code, 0);
  const std::string observations = read_file(*this / "tables/observations_sbot.csv");
  EXPECT_EQ(std::ranges::count(observations, '\n'), 1 + 71);
}

TEST_F(LiveRecordings, ContinueThroughActionsResetsAndRewinds) {
  const FieldOfRobots field(3, 1e4);
  ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"});
  Process recording(record(run, "run.mcap"));
  ASSERT_TRUE(recording.wait_for_output("recorded from tick 0 on")) << recording.output();
  run.done({"step", "120"});
  run.done({"set-pose", "swarm/sbot_2", "--pose", "2 2 0.02"});
  run.done({"step", "30"});
  run.done({"back", "1"});
  run.done({"step", "20"});
  run.done({"reset", "--seed", "9"});
  run.done({"step", "40"});
  run.done({"shutdown"});
  run.finish();
  EXPECT_EQ(recording.wait_for_exit(), 0) << recording.output();
  EXPECT_EQ(verify("run.mcap"), "identical, 213 ticks\n") << "0 to 150, 100 to 120, 0 to 40";
}

TEST_F(LiveRecordings, StopOnRequestWhileTheRunContinues) {
  const FieldOfRobots field(2, 1e5);
  ControlledRun run(field);
  for (const int signal : {SIGINT, SIGTERM}) {
    Process recording(record(run, "run.mcap"));
    ASSERT_TRUE(recording.wait_for_output("recorded from tick ")) << recording.output();
    const std::uint64_t tick = run.tick();
    EXPECT_TRUE(run.comes_to([&](const auto& now) { return now["tick"] > tick + 50; }));
    recording.signal(signal);
    EXPECT_EQ(recording.wait_for_exit(), 0) << recording.output();
    EXPECT_NE(recording.output().find("MB, stopped"), std::string::npos) << recording.output();
    EXPECT_TRUE(verify("run.mcap").starts_with("identical, ")) << verify("run.mcap");
  }
  run.done({"shutdown"});
  EXPECT_GE(events_of(run.finish(), "control").size(), 3u);
}

TEST_F(LiveRecordings, EndWithTheirClientAndCanBeRestarted) {
  const FieldOfRobots field(2, 1e5);
  ControlledRun run(field);
  for (int i = 0; i < 6; ++i) {  // more than there may be at a time
    Process recording(record(run, "killed.mcap"));
    ASSERT_TRUE(recording.wait_for_output("recorded from tick ")) << recording.output();
    recording.signal(SIGKILL);
    recording.wait_for_exit();
    const std::uint64_t tick = run.tick();
    EXPECT_TRUE(run.comes_to([&](const auto& now) { return now["tick"] > tick; })) << "it goes on";
    EXPECT_TRUE(run.comes_to([&](const auto&) {  // the server notices at the latest when its lease is over
      Process next(record(run, "next.mcap"));
      const bool has_begun = next.wait_for_output("recorded from tick ");
      next.signal(SIGINT);
      next.wait_for_exit();
      return has_begun;
    }));
  }
  run.done({"shutdown"});
  run.finish();
}

TEST_F(LiveRecordings, AreClosedWhenTheServerIsKilled) {
  const FieldOfRobots field(2, 1e5);
  ControlledRun run(field, {"--speed", "5"});
  Process recording(record(run, "run.mcap"));
  ASSERT_TRUE(recording.wait_for_output("recorded from tick ")) << recording.output();
  const auto size = [&] { return std::filesystem::file_size(*this / "run.mcap"); };
  EXPECT_TRUE(run.comes_to([&](const auto&) { return size() > 50'000; }));
  run.server().signal(SIGKILL);
  EXPECT_EQ(recording.wait_for_exit(), 1) << recording.output();
  EXPECT_NE(recording.output().find("the recording ended before the run: the server is gone"), std::string::npos)
      << recording.output();
  EXPECT_TRUE(verify("run.mcap").starts_with("identical, ")) << verify("run.mcap");
}

TEST_F(LiveRecordings, DoNotBlockTheRunIfTheyAreNotFetched) {
  const FieldOfRobots field(4, 20.0);
  ControlledRun run(field, {"--paused"});
  Control control = control_of(run);
  EXPECT_EQ(control.start_recording(R"({"poses": 100, "observations": 100})").message, "recorded from tick 0 on");
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
}

TEST_F(LiveRecordings, AreRejectedWithTheReason) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Ended ended = run_to_end(record(run, "no.mcap", arguments));
    EXPECT_NE(ended.exit_code, 0);
    return ended.err;
  };
  EXPECT_NE(refused({"--robots", "nobody"}).find("nobody"), std::string::npos);
  EXPECT_NE(refused({"--poses", "-1"}).find("--poses"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(*this / "no.mcap"));
  Control control = control_of(run);
  for (const char* text : {"{pose: 3}", "[", "{snapshots: soon}", "{robots: [nobody]}", "7"})
    EXPECT_THROW(control.start_recording(text), ControlError) << text;
  control.start_recording();
  EXPECT_THROW(control.start_recording(), ControlError) << "one at a time";
  EXPECT_THROW(control.fetch_recording(1'000'000'000), ControlError);
  std::vector<std::unique_ptr<Process>> more;
  for (int i = 0; i < 3; ++i) {
    more.push_back(std::make_unique<Process>(record(run, std::to_string(i) + ".mcap")));
    ASSERT_TRUE(more.back()->wait_for_output("recorded from tick 0 on")) << more.back()->output();
  }
  EXPECT_NE(refused({}).find("4 recordings of this run are active"), std::string::npos);
  run.done({"step", "5"});
  run.done({"shutdown"});
  run.finish();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(more[static_cast<std::size_t>(i)]->wait_for_exit(), 0);
    EXPECT_EQ(verify(std::to_string(i) + ".mcap"), "identical, 6 ticks\n");
  }
}

}  // namespace
}  // namespace cohort::test
