// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <mutex>

#include "tests/commands/small_experiment.hpp"
#include "tools/common/processes/children.hpp"

namespace cohort::test {
namespace {

// Reads a line of /proc/PID/status that contains a mask of signals.
bool has_signal(pid_t pid, const std::string& mask, int number) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(mask + ":"))
      return (std::stoull(line.substr(mask.size() + 1), nullptr, 16) >> (number - 1) & 1) != 0;
  return false;
}

class NoProcessIsLeftBehind : public ::testing::Test {
 protected:
  // A run whose controllers have started, and its processes.
  void start(const std::vector<std::string>& arguments = {}, const Process::Environment& environment = {},
             const std::string& begun = "simulated") {
    std::vector<std::string> command = experiment.run({"--summary", (experiment / "summary.json").string()});
    command.insert(command.end(), arguments.begin(), arguments.end());
    run.emplace(command, environment);
    ASSERT_TRUE(run->wait_for_output(begun)) << run->output();
    controllers = children_of(run->pid());
    ASSERT_FALSE(controllers.empty());
  }
  void expect_nothing_left() {
    for (const pid_t controller : controllers) EXPECT_TRUE(wait_until_gone(controller));
  }
  void expect_an_orderly_end() {
    EXPECT_EQ(run->wait_for_exit(), 130) << run->output();
    EXPECT_NE(run->output().find("state hash"), std::string::npos) << run->output();
    EXPECT_FALSE(read_json(experiment / "summary.json").empty());
    expect_nothing_left();
  }

  SmallExperiment experiment;
  std::optional<Process> run;
  std::vector<pid_t> controllers;
};

class Interrupted : public NoProcessIsLeftBehind, public ::testing::WithParamInterface<int> {};

TEST_P(Interrupted, EndsItsControllersAndPrintsTheSummary) {
  start({"--controllers", "per-robot"});
  EXPECT_EQ(controllers.size(), 2u);
  run->signal(GetParam());
  expect_an_orderly_end();
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& parameter) { return "SIG" + std::string(sigabbrev_np(parameter.param)); });

TEST_F(NoProcessIsLeftBehind, WhenCohortIsKilled) {
  start({"--controllers", "per-robot"});
  run->signal(SIGKILL);
  EXPECT_EQ(run->wait_for_exit(), 128 + SIGKILL);
  expect_nothing_left();
}

TEST_F(NoProcessIsLeftBehind, WhenItsTerminalIsClosed) {
  const std::vector<std::string> command = experiment.run({"--summary", (experiment / "summary.json").string()});
  int terminal = -1;
  const pid_t pid = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (pid == 0) {
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  if (pid < 0 && errno == ENOENT) GTEST_SKIP() << "this machine has no pseudo-terminals";
  ASSERT_GT(pid, 0);
  std::string seen;
  char buffer[256];
  for (ssize_t size = 0;
       seen.find("simulated") == std::string::npos && (size = read(terminal, buffer, sizeof buffer)) > 0;)
    seen.append(buffer, static_cast<std::size_t>(size));
  controllers = children_of(pid);
  EXPECT_EQ(controllers.size(), 1u);
  close(terminal);
  int status = 0;
  ASSERT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << status;
  EXPECT_FALSE(read_json(experiment / "summary.json").empty());
  expect_nothing_left();
}

TEST_F(NoProcessIsLeftBehind, AndNohupIsRespected) {
  SmallExperiment short_one(test_controller("misbehaving"), "", 0.5);
  Process nohup(
      {"/bin/sh", "-c", "trap '' HUP; exec \"$@\"", "sh", cohort_program(), "run", short_one.file(), "--speed", "1"});
  ASSERT_TRUE(nohup.wait_for_output("simulated")) << nohup.output();
  nohup.signal(SIGHUP);
  EXPECT_EQ(nohup.wait_for_exit(), 0) << nohup.output();
}

TEST_F(NoProcessIsLeftBehind, WhenAControllerIsStoppedAndAnotherIsStuckAndIgnoresSignals) {
  start({"--controllers", "per-robot"}, {{"COHORT_TEST_FAULT", "be deaf"}, {"COHORT_TEST_ROBOT", "r0"}}, "stuck");
  kill(controllers.back(), SIGSTOP);
  run->signal(SIGINT);
  expect_an_orderly_end();
  EXPECT_NE(run->output().find("team 'pair' (r0): process"), std::string::npos) << run->output();
  EXPECT_NE(run->output().find("was killed"), std::string::npos) << run->output();
}

TEST_F(NoProcessIsLeftBehind, AfterASecondCtrlCWithAControllerThatIsStuck) {
  start({}, {{"COHORT_TEST_FAULT", "loop"}}, "stuck");
  run->signal(SIGINT);
  ASSERT_TRUE(eventually([&] { return !has_signal(run->pid(), "SigCgt", SIGINT); }));
  run->signal(SIGINT);
  EXPECT_EQ(run->wait_for_exit(), 128 + SIGINT);
  EXPECT_EQ(run->output().find("state hash"), std::string::npos) << "it did not wait";
  expect_nothing_left();
}

TEST_F(NoProcessIsLeftBehind, AfterASecondCtrlCWithAControllerThatIsStuckInTheServersProcess) {
  Process here(experiment.run({"--controllers", "inprocess"}), {{"COHORT_TEST_FAULT", "loop"}});
  ASSERT_TRUE(here.wait_for_output("stuck"));
  here.signal(SIGINT);
  ASSERT_TRUE(eventually([&] { return !has_signal(here.pid(), "SigCgt", SIGINT); }));
  here.signal(SIGINT);
  EXPECT_EQ(here.wait_for_exit(), 128 + SIGINT);
}

TEST_F(NoProcessIsLeftBehind, IncludingProcessesOfAController) {
  const std::string file = (experiment / "helper").string();
  start({}, {{"COHORT_TEST_FAULT", "start a helper"}, {"COHORT_TEST_ROBOT", "r0"}, {"COHORT_TEST_FILE", file}},
        "helped");
  const pid_t first_helper = std::stoi(read_file(file));
  EXPECT_TRUE(is_alive(first_helper));
  kill(controllers[0], SIGKILL);
  EXPECT_TRUE(wait_until_gone(first_helper)) << "with the controller that died";

  ASSERT_TRUE(eventually([&] {
    const std::string helper = read_file(file);
    return helper.ends_with('\n') && std::stoi(helper) != first_helper;
  }));
  const pid_t second_helper = std::stoi(read_file(file));
  run->signal(SIGINT);
  expect_an_orderly_end();
  EXPECT_TRUE(wait_until_gone(second_helper)) << "with the run";
}

// ---- The class ----

class ChildrenTest : public ::testing::Test {
 protected:
  using Children = tool::Children;

  Children::Listener listener() {
    return {.started =
                [this](const Children::Command&, pid_t pid) {
                  const std::lock_guard lock(mutex_);
                  pids_.push_back(pid);
                },
            .restarted = [this](const auto&, const std::string& text) { add(text); },
            .gave_up = [this](const std::string& text) { add("gave up: " + text); }};
  }
  std::vector<pid_t> pids() {
    const std::lock_guard lock(mutex_);
    return pids_;
  }
  std::vector<std::string> texts() {
    const std::lock_guard lock(mutex_);
    return texts_;
  }

 private:
  void add(const std::string& text) {
    const std::lock_guard lock(mutex_);
    texts_.push_back(text);
  }
  std::mutex mutex_;
  std::vector<pid_t> pids_;
  std::vector<std::string> texts_;
};

TEST_F(ChildrenTest, EndWhenAnExceptionPropagates) {
  try {
    const Children children({{{"/bin/sleep", "1000"}, "one"}, {{"/bin/sleep", "1000"}, "two"}}, listener());
    ASSERT_TRUE(eventually([&] { return pids().size() == 2; }));
    throw std::runtime_error("in the midst of set-up");
  } catch (const std::runtime_error&) {
  }
  for (const pid_t pid : pids()) EXPECT_FALSE(is_alive(pid));
  EXPECT_TRUE(texts().empty());
}

TEST_F(ChildrenTest, AreReapedWithoutAnnouncementsOfTheKernel) {
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);
  close(next);
  rlimit none_left = before;
  none_left.rlim_cur = static_cast<rlim_t>(next) + 2;  // for the pipe that wakes it
  setrlimit(RLIMIT_NOFILE, &none_left);
  {
    const Children children({{{"/bin/false"}, "false"}}, listener());
    EXPECT_TRUE(eventually([&] { return texts().size() == 4; }));
  }
  setrlimit(RLIMIT_NOFILE, &before);
  ASSERT_EQ(texts().size(), 4u);
  EXPECT_NE(texts()[2].find("false: controller process"), std::string::npos) << texts()[2];
  EXPECT_NE(texts()[2].find("restarting it (3 of 3)"), std::string::npos) << texts()[2];
  EXPECT_TRUE(texts()[3].starts_with("gave up")) << texts()[3];
}

TEST_F(ChildrenTest, HaveEmptyInputAndInheritNoDescriptors) {
  const int zero = open("/dev/zero", O_RDONLY);
  const int descriptor = fcntl(zero, F_DUPFD, 100);  // without close-on-exec, where the shell has none of its own
  close(zero);
  const std::string inherited = "/proc/$$/fd/" + std::to_string(descriptor);
  std::mutex mutex;
  std::vector<std::string> lines;
  Children::Listener its_listener = listener();
  its_listener.wrote = [&](const auto&, const std::string& line) {
    const std::lock_guard lock(mutex);
    lines.push_back(line);
  };
  {
    const std::string script = "cat; readlink /proc/self/fd/0 >&2; test -e " + inherited +
                               " && echo inherited >&2 || echo closed >&2; sleep 1000";
    Children children({{{"/bin/sh", "-c", script}, "sh"}}, its_listener);
    EXPECT_TRUE(eventually([&] {
      const std::lock_guard lock(mutex);
      return lines.size() == 2;
    }));
    children.stop_restarting();
  }
  close(descriptor);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "/dev/null");
  EXPECT_EQ(lines[1], "closed");
}

}  // namespace
}  // namespace cohort::test
