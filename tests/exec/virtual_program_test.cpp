// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/virtual_program.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/exec/virtual_run.hpp"

namespace cohort::test {
namespace {

std::string why_not(const std::vector<std::string>& command) {
  try {
    const VirtualProgram program({.command = command});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

const std::string all_waits = COHORT_BUILD_DIR "/bin/wait_in_every_way";

TEST(VirtualProgram, EveryWaitTakesWhatItAsksForByTheProgramsClock) {
  const Ran ran = run({all_waits});
  EXPECT_EQ(ran.exit_code, 4);
  EXPECT_EQ(ran.told, std::vector<std::string>{});
  for (const char* line : {
           "begins at 0\n",
           "sleep 2000.000000 ms, 0\n",
           "usleep 1.500000 ms, 0\n",
           "nanosleep 0.250000 ms, 0\n",
           "clock_nanosleep_to_a_date 3.000000 ms, 0\n",
           "sleep_for 7.000000 ms, 0\n",
           "system_clock 4.000000 ms, 4000000\n",
           "steady_clock 5.000000 ms, 5000000\n",
           "poll 20.000000 ms, 0\n",
           "ppoll 30.000000 ms, 0\n",
           "select 40.000000 ms, 0\n",
           "epoll_wait 50.000000 ms, 0\n",
           "poll_that_is_ended 12.000000 ms, 1\n",
           "epoll_wait_at_once 0.000000 ms, 1\n",
           "recv 60.000000 ms, -1\n",
           "poll_at_once 0.000000 ms, 0\n",
           "epoll_wait_for_nothing 0.000000 ms, 0\n",
           "poll_of_two 12.000000 ms, 111\n",
           "epoll_pwait 0.000000 ms, 177\n",
           "select_that_is_ended 12.000000 ms, 128000\n",
           "recv_at_once 0.000000 ms, -1\n",
           "recv_that_is_ended 9.000000 ms, 1\n",
           "alarm_that_is_taken_back 2000.000000 ms, 3\n",
           "nanosleep_that_is_interrupted 5.000000 ms, 15000000\n",
           "timerfd is off: 0\ntimerfd has 20000000 left, every 7000000\ntimerfd has not fired: 1\n",
           "told at 3 5! 8 10! 13 15! 18 20!\n",
           "timerfd 5.000000 ms, 1\n",
           "timerfd 10.000000 ms, 1\n",
           "timerfd_that_was_missed 0.000000 ms, 3\n",
           "alarm 1000.000000 ms, 1\n",
           "setitimer 30.000000 ms, 4\n",
           "timer_create 15.000000 ms, 5\n",
           "wait_for 25.000000 ms, 0\n",
           "wait_for_that_is_ended 8.000000 ms, 1\n",
           "pthread_cond_timedwait 9.000000 ms, 1\n",
           "sem_timedwait 11.000000 ms, -1\n",
           "sem_clockwait_that_is_ended 6.000000 ms, 0\n",
           "future 13.000000 ms, 1\n",
           "child 70.000000 ms, 5\n",
           "shell 80.000000 ms, 6\n",
       })
    EXPECT_NE(ran.output.find(line), std::string::npos) << line << "is not in\n" << ran.output;
}

TEST(VirtualProgram, ItsThreadsDoNotRaceAndASpinningOneSeesTimePass) {
  const Ran first = run({all_waits});
  const Ran second = run({all_waits});
  EXPECT_EQ(first.output, second.output);
  EXPECT_EQ(first.time, second.time);
  EXPECT_NE(first.output.find("race "), std::string::npos);
  EXPECT_NE(first.output.find("spin 10."), std::string::npos) << first.output;
}

TEST(VirtualProgram, RunsPython) {
  const std::string script =
      "import asyncio, datetime, queue, threading, time\n"
      "def since(begin): return round((time.monotonic() - begin) * 1000, 6)\n"
      "t = time.monotonic(); time.sleep(0.25); print('sleep', since(t))\n"
      "t = time.monotonic(); threading.Event().wait(0.3); print('event', since(t))\n"
      "t = time.monotonic()\n"
      "try: queue.Queue().get(timeout=0.1)\n"
      "except queue.Empty: print('queue', since(t))\n"
      "t = time.monotonic(); asyncio.run(asyncio.sleep(0.15)); print('asyncio', since(t))\n"
      "print(datetime.datetime.now(datetime.timezone.utc).isoformat())\n";
  const ScratchFolder folder;
  write_file(folder / "script.py", script);
  const Ran ran = run({"python3", (folder / "script.py").string()});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_NE(ran.output.find("sleep 250.0\nevent 300.0\nqueue 100.0\nasyncio 15"), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("1970-01-01T00:00:00.8"), std::string::npos) << ran.output;
}

TEST(VirtualProgram, GoesOnInRealTimeWhenItIsToEnd) {
  const ScratchFolder folder;
  write_file(folder / "script.sh", "trap 'sleep 0.01; exit 9' TERM\nwhile :; do sleep 1000 & wait $!; done\n");
  VirtualProgram program({.command = {"bash", (folder / "script.sh").string()}});
  ASSERT_TRUE(program.run_now());
  EXPECT_EQ(program.end(patience), 9);
  EXPECT_EQ(program.exit_code(), 9);
}

TEST(VirtualProgram, WaitsTakeTheirTimeWhenTheyGoOnInRealTime) {
  const ScratchFolder folder;
  write_file(folder / "script.py",
             "import select, signal, sys, threading, time\n"
             "def measure(*_):\n"
             "    for wait in (lambda: time.sleep(0.2), lambda: threading.Event().wait(0.2),\n"
             "                 lambda: select.select([], [], [], 0.2)):\n"
             "        begin, uptime = time.monotonic(), float(open('/proc/uptime').read().split()[0])\n"
             "        wait()\n"
             "        took = time.monotonic() - begin\n"
             "        really = float(open('/proc/uptime').read().split()[0]) - uptime\n"
             "        print(0.19 < took, 0.18 < really, flush=True)\n"
             "    sys.exit(9)\n"
             "signal.signal(signal.SIGTERM, measure)\n"
             "print('ready', flush=True)\n"
             "while True: time.sleep(1000)\n");
  VirtualProgram program({.command = {"sh", "-c", "exec python3 script.py > output"}, .folder = folder.path()});
  ASSERT_TRUE(eventually([&] { return program.settle() && read_file(folder / "output") == "ready\n"; }));
  EXPECT_EQ(program.end(patience), 9);
  EXPECT_EQ(read_file(folder / "output"), "ready\nTrue True\nTrue True\nTrue True\n");
}

TEST(VirtualProgram, WaitsForDataOfDdsEndAtTheirTimeToo) {
  const Ran ran = run({COHORT_BUILD_DIR "/bin/wait_for_data"});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.output,
            "nothing within 250 ms: 0\nnothing until then, after 100 ms: 0\ntriggered after 30 ms: 1\nslept 40 ms\n");
}

TEST(VirtualProgram, SaysWhyAProgramCannotHaveVirtualTime) {
  EXPECT_EQ(why_not({COHORT_BUILD_DIR "/bin/wait_statically"}),
            "'" COHORT_BUILD_DIR
            "/bin/wait_statically' cannot run in virtual time: it is linked statically; link it "
            "dynamically");
  EXPECT_EQ(why_not({"no-such-program"}), "no program 'no-such-program' in $PATH");
  EXPECT_EQ(why_not({"/etc/passwd"}), "'/etc/passwd' is not an executable file");
  const ScratchFolder folder;
  write_file(folder / "data", "nothing that runs\n");
  std::filesystem::permissions(folder / "data", std::filesystem::perms::owner_all);
  EXPECT_NE(why_not({(folder / "data").string()}).find("it is neither a program nor a script"), std::string::npos);
  EXPECT_NE(why_not({"/usr/bin/passwd"}).find("it is set-user-ID or set-group-ID"), std::string::npos);
}

TEST(VirtualProgram, NamesWhatRunsInRealTimeOrNeverWaits) {
  const ScratchFolder folder;
  std::vector<std::string> told;
  VirtualProgram::Options options;
  options.command = {"sh", "-c", COHORT_BUILD_DIR "/bin/wait_statically & while :; do :; done"};
  options.tell = [&](const std::string& text) { told.push_back(text); };
  const auto begin = std::chrono::steady_clock::now();
  options.given_up = [&] { return !told.empty() || std::chrono::steady_clock::now() - begin > patience; };
  VirtualProgram program(options);
  EXPECT_FALSE(program.run_now());
  ASSERT_FALSE(told.empty());
  EXPECT_NE(told.front().find("has not waited for anything for 5 s, so simulated time does not advance: 'sh' (thread"),
            std::string::npos)
      << told.front();

  told.clear();
  options.command = {"sh", "-c", COHORT_BUILD_DIR "/bin/wait_statically"};
  VirtualProgram other(options);
  while (told.empty() && std::chrono::steady_clock::now() - begin < patience) other.settle();
  ASSERT_FALSE(told.empty());
  EXPECT_NE(told.front().find("runs in real time: it is linked statically"), std::string::npos) << told.front();
}

std::vector<std::string> told_of_a_child(const std::vector<std::string>& command) {
  std::vector<std::string> told;
  VirtualProgram::Options options;
  options.command = command;
  options.tell = [&](const std::string& text) { told.push_back(text); };
  const auto begin = std::chrono::steady_clock::now();
  options.given_up = [&] { return std::chrono::steady_clock::now() - begin > patience; };
  VirtualProgram program(options);
  while (told.empty() && std::chrono::steady_clock::now() - begin < patience && program.run_now() &&
         program.run_before(program.time() + 10ms)) {
  }
  return told;
}

// A shell starts a program by fork or by vfork, or becomes it. None of them may say that the library is still in it.
TEST(VirtualProgram, NamesAProgramWithoutTheLibraryHoweverAScriptStartsIt) {
  const std::string program = COHORT_BUILD_DIR "/bin/wait_statically";
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"bash", "-c", program + "; true"},
           {"bash", "-c", program},
           {"sh", "-c", "(" + program + "); true"},
           {"sh", "-c", "(sleep 0.01; exec " + program + ") & wait"},
           {"python3", "-c", "import os\nif os.fork() == 0: os.execv('" + program + "', ['x'])\nos.wait()"}}) {
    const std::vector<std::string> told = told_of_a_child(command);
    ASSERT_EQ(told.size(), 1u) << command[2];
    EXPECT_NE(told[0].find("('" + program + "')"), std::string::npos) << told[0];
    EXPECT_NE(told[0].find("runs in real time: it is linked statically"), std::string::npos) << told[0];
  }
}

// With cgo, which packages for names and networks use, a Go program is linked dynamically and loads the library.
TEST(VirtualProgram, NamesAGoProgramThatLoadsTheLibraryButDoesNotCallIt) {
  const std::string program = COHORT_BUILD_DIR "/bin/wait_like_go";
  const std::vector<std::string> told = told_of_a_child({"sh", "-c", program + "; true"});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("('" + program + "')"), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("runs in real time: it is a Go program, which makes system calls without the C library"),
            std::string::npos)
      << told[0];
}

TEST(VirtualProgram, NamesAThreadThatSleepsWithoutTheCLibraryButNoneOfDds) {
  const std::string program = COHORT_BUILD_DIR "/bin/sleep_in_real_time";
  const Ran kernel = run({program, "kernel"}, 1h);
  EXPECT_EQ(kernel.exit_code, 0);
  ASSERT_EQ(kernel.told.size(), 1u);
  EXPECT_TRUE(kernel.told[0].ends_with("' sleeps in real time: it makes system calls without the C library"))
      << kernel.told[0];
  const Ran dds = run({program, "dds"}, 1h);
  EXPECT_EQ(dds.exit_code, 0);
  EXPECT_EQ(dds.told, std::vector<std::string>{});
}

// Others may wait for what it holds.
TEST(VirtualProgram, IsNotAtRestWhileAThreadOfDdsSleepsInRealTimeButWhileOneDoesSoAgainAndAgain) {
  const std::string program = COHORT_BUILD_DIR "/bin/sleep_in_real_time";
  const Ran once = run({program, "dds"}, 1h);
  EXPECT_EQ(once.exit_code, 0);
  EXPECT_LE(once.time, 50ms);
  const Ran often = run({program, "often in dds"}, 1h);
  EXPECT_EQ(often.exit_code, 0);
  EXPECT_GE(often.time, 1s);
}

}  // namespace
}  // namespace cohort::test
