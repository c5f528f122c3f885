// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"
#include "client_sdk/include/cohort/controller.hpp"
#include "tests/support/counting_controller.hpp"
#include "tests/support/files.hpp"

namespace cohort {
namespace {

using namespace test;

// Returns the message of the exception that `call` throws.
template <class Error, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "it throws nothing";
  return "";
}

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in '" << text << "'";
}

Start sbot_start() {
  Start start;
  start.name = "explorers/sbot_7";
  start.model = "sbot";
  for (std::uint32_t i = 0; i < 15; ++i) {
    start.observation_channels.push_back({"proximity/" + std::to_string(i) + "/reading", "1", i, 1, 0.0, 1.0, 0.0});
  }
  start.observation_channels.push_back({"imu/0/acceleration", "m/s^2", 15, 3, -100.0, 100.0, 0.0});
  start.command_channels = {{"treel/left/velocity", "m/s", 0, 1, -0.2, 0.2, 0.0},
                            {"treel/right/velocity", "m/s", 1, 1, -0.2, 0.2, 0.0}};
  return start;
}

TEST(StartLookup, FindsAChannelByItsName) {
  const Start start = sbot_start();
  EXPECT_EQ(start.observation("imu/0/acceleration").offset, 15u);
  EXPECT_EQ(start.observation("imu/0/acceleration").size, 3u);
  const CommandChannel right = start.command("treel/right/velocity");
  EXPECT_EQ(right.offset, 1u);
  EXPECT_EQ(right.upper, 0.2);
}

TEST(StartLookup, AStarMatchesAnyCharactersExceptASlash) {
  const Start start = sbot_start();
  EXPECT_EQ(start.observations("proximity/*/reading").size(), 15u);
  EXPECT_EQ(start.observations("proximity/*/reading")[3].offset, 3u);
  EXPECT_EQ(start.observations("proximity/1*/reading").size(), 6u);
  EXPECT_EQ(start.observations("*/*/*").size(), 16u);
  EXPECT_EQ(start.commands("treel/*t/velocity").size(), 2u);
  EXPECT_THROW(start.observations("*"), ChannelError);
  EXPECT_THROW(start.observations("proximity/*"), ChannelError);
}

TEST(StartLookup, ChecksTheNumberOfMatchingChannels) {
  const Start start = sbot_start();
  EXPECT_EQ(start.observations("proximity/*/reading", 15).size(), 15u);
  EXPECT_TRUE(contains(message_of<ChannelError>([&] { start.observations("proximity/*/reading", 8); }),
                       "has 15 observation channels that match 'proximity/*/reading', expected 8"));
}

TEST(StartLookup, AMisspelledNameIsReportedWithTheNearestNames) {
  const Start start = sbot_start();
  const std::string message = message_of<ChannelError>([&] { start.observation("proximty/3/reading"); });
  EXPECT_TRUE(contains(message, "robot 'explorers/sbot_7' (sbot) has no observation channel 'proximty/3/reading'"));
  EXPECT_TRUE(contains(message, "the nearest are proximity/3/reading"));
  EXPECT_TRUE(contains(message_of<ChannelError>([&] { start.commands("treels/*/velocity"); }), "treel/left/velocity"));
}

TEST(CommandValues, AreClampedToTheirRangeButNanIsPassedOn) {
  std::vector<double> values(2);
  Command command(values);
  const CommandChannel right = sbot_start().command("treel/right/velocity");
  command.set(right, 7.0);
  EXPECT_EQ(values[1], 0.2);
  command.set(right, -7.0);
  EXPECT_EQ(values[1], -0.2);
  command.set(right, std::nan(""));
  EXPECT_TRUE(std::isnan(values[1]));
}

std::string name_of(std::uint32_t robot) { return std::string("r").append(std::to_string(robot)); }

class ControllerHostTest : public testing::Test {
 protected:
  void start(wire::StartReason reason = wire::StartReason::first, const std::vector<std::uint32_t>& robots = {2, 5}) {
    wire::Admit admit{.start_reason = reason, .tick = 100, .step_ns = 10'000'000};
    for (const std::uint32_t robot : robots) admit.robots.push_back({.robot = robot, .name = name_of(robot)});
    host.start(admit, descriptions);
  }
  std::vector<double> answer(std::uint64_t tick, std::vector<std::uint32_t> robots, std::vector<double> values) {
    const auto result = host.answer({.tick = tick, .robots = robots, .values = values});
    return {result.begin(), result.end()};
  }

  std::vector<wire::RobotDescription> descriptions{CountingController::description()};
  ControllerHost host{CountingController::plugin()};
};

TEST_F(ControllerHostTest, AnswersRobotAfterRobotInTheOrderOfTheFrame) {
  start();
  EXPECT_EQ(answer(100, {2, 5}, {0.5, -0.5}),
            (std::vector<double>{1, 100, 1.0, 0, 0.25, 0.25, 1, 100, -1.0, 0, 0.25, 0.25}));
  EXPECT_EQ(answer(101, {5}, {0.25}), (std::vector<double>{2, 101, 0.5, 0, 0.25, 0.25}));
}

TEST_F(ControllerHostTest, EveryStepBeginsWithNeutralValues) {
  struct OnceController final : Controller {
    void start(const Start& start) override { channel = start.command("count/0/unused"); }
    void step(const Observation& observation, Command& command) override {
      if (observation.tick() == 0) command.set(channel, -1.0, 1);
    }
    CommandChannel channel;
  };
  ControllerHost once({Plugin::current_abi, "once", []() -> Controller* { return new OnceController; },
                       [](Controller* controller) { delete controller; }});
  once.start({.robots = {{.robot = 0}}}, descriptions);
  const std::vector<std::uint32_t> robots{0};
  const std::vector<double> values{0.0};
  EXPECT_EQ(once.answer({.tick = 0, .robots = robots, .values = values})[5], -1.0);
  EXPECT_EQ(once.answer({.tick = 1, .robots = robots, .values = values})[5], 0.25);
}

TEST_F(ControllerHostTest, AResetAndARestoreKeepTheControllersAndATakeoverMakesNewOnes) {
  start();
  answer(100, {2, 5}, {0, 0});
  start(wire::StartReason::reset);
  EXPECT_EQ(answer(100, {2}, {0}), (std::vector<double>{2, 100, 0, 2, 0.25, 0.25}));
  start(wire::StartReason::restored, {2, 3, 5});
  EXPECT_EQ(answer(101, {2}, {0}), (std::vector<double>{3, 101, 0, 3, 0.25, 0.25}));
  EXPECT_EQ(answer(101, {3}, {0}), (std::vector<double>{1, 101, 0, 3, 0.25, 0.25})) << "new in this run";
  start(wire::StartReason::takeover);
  EXPECT_EQ(answer(102, {2}, {0}), (std::vector<double>{1, 102, 0, 1, 0.25, 0.25}));
}

TEST_F(ControllerHostTest, AnExceptionIsReportedWithRobotTickAndReason) {
  start();
  const std::string message = message_of<ControllerFailure>([&] { answer(123, {2, 5}, {0, -1}); });
  EXPECT_TRUE(contains(message, "robot 'r5' failed in step at tick 123: it hurts"));
}

TEST_F(ControllerHostTest, AnyExceptionIsAControllerFailure) {
  struct OddController final : Controller {
    void start(const Start&) override { throw 42; }
    void step(const Observation&, Command&) override {}
  };
  ControllerHost odd({Plugin::current_abi, "odd", []() -> Controller* { return new OddController; },
                      [](Controller* controller) { delete controller; }});
  const std::string message =
      message_of<ControllerFailure>([&] { odd.start({.robots = {{.robot = 0, .name = "r0"}}}, descriptions); });
  EXPECT_TRUE(contains(message, "robot 'r0' failed in start"));
}

TEST_F(ControllerHostTest, AMissingChannelFailsTheStartWithTheNearestNames) {
  descriptions[0].observation[0].name = "sensor/0/readin";
  EXPECT_TRUE(contains(message_of<ControllerFailure>([&] { start(); }), "the nearest are sensor/0/readin"));
}

TEST_F(ControllerHostTest, AFrameThatDoesNotMatchTheDescriptionsIsRefused) {
  start();
  EXPECT_TRUE(contains(message_of<ControllerFailure>([&] { answer(100, {2, 5}, {0}); }), "has 1 values"));
  EXPECT_TRUE(contains(message_of<ControllerFailure>([&] { answer(100, {4}, {0}); }), "robot 4"));
  descriptions.clear();
  EXPECT_TRUE(contains(message_of<ControllerFailure>([&] { start(); }), "sent no description of"));
}

class PluginLoaderTest : public testing::Test {
 protected:
  // Compiles C source to a shared object; returns false without a compiler.
  bool compile(const std::string& name, const std::string& source) {
    std::ofstream(folder / "source.c") << source;
    const std::string command = "cc -shared -fPIC -o '" + (folder / (name + ".so")).string() + "' '" +
                                (folder / "source.c").string() + "' 2> /dev/null";
    return std::system(command.c_str()) == 0;
  }

  ScratchFolder scratch;
  std::filesystem::path folder = scratch.path();
};

TEST_F(PluginLoaderTest, AMissingPluginIsReportedWithTheSearchedPaths) {
  const std::string message = message_of<std::runtime_error>([&] {
    LoadedPlugin("no_such", {folder, folder / "deeper"});
  });
  EXPECT_TRUE(contains(message, (folder / "no_such.so").string()));
  EXPECT_TRUE(contains(message, (folder / "deeper/no_such.so").string()));
  EXPECT_TRUE(contains(message, "COHORT_PLUGIN_PATH"));
}

TEST_F(PluginLoaderTest, AFileThatIsNotALibraryIsRefused) {
  std::ofstream(folder / "text.so") << "hello";
  EXPECT_TRUE(
      contains(message_of<std::runtime_error>([&] { LoadedPlugin("text", {folder}); }), "is not a shared object"));
}

TEST_F(PluginLoaderTest, ALibraryThatIsNotAPluginIsRefused) {
  Dl_info libc{};
  ASSERT_NE(::dladdr(reinterpret_cast<void*>(&std::atoi), &libc), 0);
  std::filesystem::create_symlink(std::filesystem::absolute(libc.dli_fname), folder / "libc.so");
  EXPECT_TRUE(
      contains(message_of<std::runtime_error>([&] { LoadedPlugin("libc", {folder}); }), "not a controller plugin"));
}

TEST_F(PluginLoaderTest, APluginOfAnotherVersionIsRefused) {
  if (!compile("old", "const struct { unsigned abi; const char* name; void *a, *b; } cohort_plugin = {77, 0, 0, 0};")) {
    GTEST_SKIP() << "no C compiler at hand";
  }
  const std::string message = message_of<std::runtime_error>([&] { LoadedPlugin("old", {folder}); });
  EXPECT_TRUE(contains(message, "version 77"));
  EXPECT_TRUE(contains(message, "Rebuild the plugin"));
}

TEST_F(PluginLoaderTest, ThePluginPathPrecedesTheFoldersOfTheProgram) {
  ::setenv("COHORT_PLUGIN_PATH", "/first::/second", 1);
  const auto directories = default_plugin_directories();
  ::unsetenv("COHORT_PLUGIN_PATH");
  ASSERT_GE(directories.size(), 4u);
  EXPECT_EQ(directories[0], "/first");
  EXPECT_EQ(directories[1], "/second");
  EXPECT_TRUE(directories[2].string().ends_with("lib/controllers")) << directories[2];
}

}  // namespace
}  // namespace cohort
