// SPDX-License-Identifier: Apache-2.0

// Threads of the Python interpreter in virtual time.

#include <gtest/gtest.h>

#include <fstream>

#include "tests/exec/virtual_run.hpp"

namespace cohort::test {
namespace {

Ran run_script(const std::string& script) {
  const ScratchFolder folder;
  write_file(folder / "script.py", script);
  return run({"python3", (folder / "script.py").string()});
}

// Work that takes another real time at each call.
const std::string burn =
    "import hashlib, os, queue, sys, threading, time\n"
    "def burn():\n"
    "    for _ in range(os.urandom(1)[0] // 16): hashlib.sha256(b'x' * 20000).digest()\n"
    "def run(*functions):\n"
    "    threads = [threading.Thread(target=each) for each in functions]\n"
    "    for each in threads: each.start()\n"
    "    for each in threads: each.join()\n"
    "out = []\n"
    "def note(*what): out.append((*what, round(time.monotonic(), 6)))\n";

TEST(PythonThreads, ThatWakeAtTheSameTimesGiveTheSameOutputInEachRun) {
  const std::string script = burn +
                             "def sleeper(name):\n"
                             "    for i in range(40): burn(); time.sleep(0.05); burn(); note(name)\n"
                             "run(*[lambda name=each: sleeper(name) for each in 'abc'])\n"
                             "expected = [(name, round(0.05 * i, 6)) for i in range(1, 41) for name in 'abc']\n"
                             "assert out == expected, out\n";
  for (int i = 0; i < 3; ++i) {
    const Ran ran = run_script(script);
    EXPECT_EQ(ran.exit_code, 0);
    EXPECT_EQ(ran.told, std::vector<std::string>{});
  }
}

TEST(PythonThreads, ThatUseQueuesLocksAndOutputGiveTheSameOutputInEachRun) {
  const std::string script = burn +
                             "work, done, lock = queue.Queue(), queue.Queue(), threading.Lock()\n"
                             "def say(*what):\n"
                             "    note(*what); print(*what, flush=True)\n"
                             "def produce():\n"
                             "    for i in range(60): time.sleep(0.025); burn(); work.put(i); say('put', i); burn()\n"
                             "    for _ in range(3): work.put(None)\n"
                             "def consume(name):\n"
                             "    while True:\n"
                             "        try: item = work.get(timeout=0.01)\n"
                             "        except queue.Empty: say(name, 'none'); continue\n"
                             "        if item is None: return\n"
                             "        burn()\n"
                             "        with lock: say(name, item); burn()\n"
                             "        done.put(item)\n"
                             "def collect():\n"
                             "    event = threading.Event()\n"
                             "    for i in range(60): event.wait(0.025); say('collected', done.get())\n"
                             "run(produce, collect, *[lambda name=each: consume(name) for each in 'abc'])\n"
                             "print(*out, sep='\\n')\n";
  const Ran first = run_script(script);
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.told, std::vector<std::string>{});
  for (int i = 0; i < 3; ++i) {
    const Ran again = run_script(script);
    EXPECT_EQ(again.output, first.output);
    EXPECT_EQ(again.time, first.time);
  }
}

TEST(PythonThreads, OneThatWaitsForAnotherWithoutACallGoesOnAndIsReported) {
  const Ran ran = run_script(
      "import threading, time\n"
      "is_done, begins = False, threading.Event()\n"
      "def work():\n"
      "    global is_done\n"
      "    begins.wait(); is_done = True\n"
      "thread = threading.Thread(target=work); thread.start()\n"
      "begins.set()\n"
      "while not is_done: pass\n"
      "thread.join(); time.sleep(0.1); print(time.monotonic())\n");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.output, "0.1\n");
  std::string told;
  for (const std::string& text : ran.told) told += text + "\n";
  EXPECT_NE(told.find("a Python thread of 'sh' has computed for 5 s while others wait for it"), std::string::npos)
      << told;
}

// The interpreter reads the clock for each lock, and how many locks an import takes depends on the machine.
TEST(PythonThreads, OneThatTakesManyLocksDoesNotSpin) {
  const Ran ran = run_script(
      "import threading, time\n"
      "lock = threading.Lock()\n"
      "for _ in range(5000):\n"
      "    with lock: pass\n"
      "print(time.monotonic())\n");
  EXPECT_EQ(ran.output, "0.0\n");
}

TEST(PythonThreads, OneThatReadsTheClockBetweenLocksSpins) {
  const Ran ran = run_script(
      "import queue, threading, time\n"
      "empty, lock = queue.Queue(), threading.Lock()\n"
      "while time.monotonic() < 0.01:\n"
      "    with lock: pass\n"
      "while time.monotonic() < 0.02:\n"
      "    try: empty.get_nowait()\n"
      "    except queue.Empty: pass\n"
      "print(time.monotonic())\n");
  EXPECT_EQ(ran.output, "0.02\n");
  EXPECT_EQ(ran.told, std::vector<std::string>{});
}

TEST(PythonThreads, OneThatAMessageWakesGoesOnWhileTheProgramsTimeIsHeld) {
  const ScratchFolder folder;
  write_file(folder / "script.py",
             "import os, threading, time\n"
             "os.mkfifo('in'); file = os.open('in', os.O_RDWR)\n"
             "def answer():\n"
             "    with open('out', 'w') as out: print(os.read(file, 6).decode(), end='', file=out, flush=True)\n"
             "threading.Thread(target=answer, daemon=True).start()\n"
             "while True: time.sleep(0.01)\n");
  VirtualProgram program({.command = {"python3", "script.py"}, .folder = folder.path()});
  ASSERT_TRUE(program.run_now());
  ASSERT_TRUE(program.run_before(100ms));
  std::ofstream(folder / "in") << "hello\n";
  EXPECT_TRUE(eventually([&] { return read_file(folder / "out") == "hello\n"; }));
}

}  // namespace
}  // namespace cohort::test
