// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/commands/small_experiment.hpp"

// Plugins that commands load, or refuse to load.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Plugins, AreNotLoadedByCommandsThatOnlyReadAnExperiment) {
  const SmallExperiment experiment;
  const std::string loaded = (experiment / "loaded").string();
  const std::vector<std::vector<std::string>> commands = {
      {"check", experiment.file()},
      {"export", experiment.file(), "-o", (experiment / "out.sdf").string()},
      {"models", "show", experiment.file()},
      {"check", experiment.file(), "--load-controllers"},
  };
  for (std::vector<std::string> command : commands) {
    const bool loads = command.back() == "--load-controllers";
    command.insert(command.begin(), cohort_program());
    const Ended ended = run_to_end(command, {{"COHORT_TEST_LOADED", loaded}});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(fs::exists(loaded), loads) << command[1];
  }
}

TEST(Plugins, AreReportedByCheckIfNotLoaded) {
  const SmallExperiment experiment;
  const std::string hint = "--load-controllers";
  EXPECT_TRUE(has(run_to_end({cohort_program(), "check", experiment.file()}).out, hint));
  EXPECT_FALSE(has(run_to_end({cohort_program(), "check", experiment.file(), hint}).out, hint));
}

TEST(Plugins, AreNotLoadedForAnotherMachine) {
  const SmallExperiment experiment("./foreign.so");
  std::string bytes = read_file(test_controller("misbehaving"));
  bytes[18] = 8;  // e_machine: MIPS
  write_file(experiment / "foreign.so", bytes);
  for (const char* command : {"check", "run"}) {
    const Ended ended = run_to_end({cohort_program(), command, experiment.file()});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_TRUE(has(ended.err, "foreign.so is a shared object for another machine")) << ended.err;
  }
}

}  // namespace
}  // namespace cohort::test
