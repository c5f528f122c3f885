// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/commands/small_experiment.hpp"

// Standard streams that are closed, full, or a pipe without a reader.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// Runs the command after a line of shell, which changes its streams or limits. `$0` is a file that does not exist.
Ended run_after(const std::string& shell, std::vector<std::string> command) {
  const ScratchFolder folder;
  command.insert(command.begin(), {"/bin/sh", "-c", shell, (folder / "new").string()});
  return run_to_end(command);
}

// Exits with 0 only if the recording is complete.
int exit_code_of_recover(const fs::path& recording, const fs::path& copy) {
  const Ended recover = run_to_end({cohort_program(), "recover", recording.string(), "-o", copy.string()});
  EXPECT_NE(recover.out.find("nothing was lost"), std::string::npos) << recover.out << recover.err;
  return recover.exit_code.value_or(-1);
}

TEST(StandardStreams, DoNotReachTheRecordingWhenTheyAreClosed) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const fs::path recording = experiment / "run.mcap";
  for (const char* closed : {"<&- >&-", ">&- 2>&-", "<&- >&- 2>&-", "<&- 2>&-"})
    for (const char* controllers : {"inprocess", "process"}) {
      const Ended run = run_after(std::string("exec \"$@\" ") + closed,
                                  experiment.run({"--record", recording.string(), "--controllers", controllers}));
      EXPECT_EQ(run.exit_code, 0) << closed << run.err;
      EXPECT_EQ(read_file(recording).find("state hash  "), std::string::npos) << closed << ' ' << controllers;
      EXPECT_EQ(exit_code_of_recover(recording, experiment / "copy.mcap"), 0) << closed << ' ' << controllers;
    }
}

TEST(StandardStreams, AreOpenInBridges) {
  const ReservedDomain domain;
  Process bridge({"/bin/sh", "-c", "exec \"$0\" \"$@\" <&- >&- 2>&-", COHORT_BUILD_DIR "/bin/cohort-epuck2-bridge",
                  "--robots", "0", "--port", "0", "--domain", domain.text()});
  const auto is_open = [&](int descriptor) {
    std::error_code error;
    const fs::path target =
        fs::read_symlink("/proc/" + std::to_string(bridge.pid()) + "/fd/" + std::to_string(descriptor), error);
    return target == "/dev/null";
  };
  EXPECT_TRUE(eventually([&] { return (is_open(0) && is_open(1) && is_open(2)) || !bridge.running(); }));
  EXPECT_TRUE(bridge.running());
}

TEST(StandardStreams, FailACommandWhoseOutputIsLost) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const std::vector<std::vector<std::string>> commands = {
      {"examples"},
      {"help"},
      {"help", "robot"},
      {"help", "sensors"},
      {"check", experiment.file()},
      {"models", "show", "sbot"},
      {"models", "show", "sbot", "--json"},
      {"run", experiment.file(), "--controllers", "inprocess"},
      {"run", experiment.file()},
      {"run", experiment.file(), "--seeds", "1..2"},
      {"--help"},
      {"run", "--help"},
      {"--version"},
  };
  for (std::vector<std::string> command : commands) {
    command.insert(command.begin(), cohort_program());
    const Ended ended = run_after("exec \"$@\" > /dev/full", command);
    EXPECT_EQ(ended.exit_code, 1) << command[1] << ended.err;
    EXPECT_NE(ended.err.find("cohort: error: standard output cannot be written: No space left on device"),
              std::string::npos)
        << command[1] << ended.err;
  }
}

TEST(StandardStreams, FailABridgeWhoseHelpIsLost) {
  const Ended ended = run_after("exec \"$@\" > /dev/full", {COHORT_BUILD_DIR "/bin/cohort-epuck2-bridge", "--help"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "cohort-epuck2-bridge: standard output cannot be written: No space left on device\n");
}

TEST(StandardStreams, ThatNobodyReadsDoNotStopARunFromWritingItsFiles) {
  const SmallExperiment experiment(test_controller("misbehaving"),
                                   "print: [{quantity: position, objects: r0, every: 0.01}]\n", 0.1);
  const std::string without_reader = "mkfifo \"$0\"; exec 3<> \"$0\" 4> \"$0\" 3<&-; exec \"$@\" >&4 4>&-";
  for (const char* controllers : {"inprocess", "process"}) {
    const std::string summary = (experiment / (std::string(controllers) + ".json")).string();
    const std::string recording = (experiment / (std::string(controllers) + ".mcap")).string();
    const Ended run = run_after(
        without_reader, experiment.run({"--summary", summary, "--record", recording, "--controllers", controllers}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("error"), std::string::npos) << run.err;
    EXPECT_EQ(read_json(summary).value("ticks", 0), 10);
    EXPECT_EQ(exit_code_of_recover(recording, experiment / "copy.mcap"), 0);
  }
}

TEST(StandardStreams, ThatNobodyReadsEndACommandThatOnlyPrints) {
  const SmallExperiment experiment;
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", experiment.file(), "--domain", domain.text()});
  ASSERT_TRUE(server.wait_for_output("serving 2 robots")) << server.output();
  const Ended watch = run_to_end({"/bin/sh", "-c", "\"$0\" \"$@\" | head -n 1", cohort_program(), "ctl", "--domain",
                                  domain.text(), "status", "--watch"});
  EXPECT_EQ(watch.exit_code, 0);
  EXPECT_EQ(watch.err, "");
}

}  // namespace
}  // namespace cohort::test
