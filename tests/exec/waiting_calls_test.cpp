// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/waiting_calls.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <regex>
#include <set>
#include <sstream>

#include "tests/exec/virtual_run.hpp"

namespace cohort::test {
namespace {

const std::string waits_of_the_table = COHORT_BUILD_DIR "/bin/wait_by_the_table";

std::vector<std::string_view> calls_that_wait(exec::Waits how) {
  std::vector<std::string_view> names;
  for (const exec::WaitingCall& call : exec::waiting_calls)
    if (call.waits == how) names.push_back(call.name);
  return names;
}

TEST(WaitingCalls, ThoseThatAreReplacedTakeTheirTimeByTheProgramsClock) {
  const Ran ran = run({waits_of_the_table});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.told, std::vector<std::string>{});
  for (const std::string_view name : calls_that_wait(exec::Waits::by_virtual_time)) {
    const std::string time = name == "sleep" || name == "alarm" ? " 1000.000000 ms\n" : " 20.000000 ms\n";
    EXPECT_NE(("\n" + ran.output).find("\n" + std::string(name) + time), std::string::npos) << name << " is not so in\n"
                                                                                            << ran.output;
  }
}

TEST(WaitingCalls, ThoseForLocksSignalsAndQueuesEndWhenAnotherThreadEndsThem) {
  const Ran ran = run({waits_of_the_table, "ended"});
  EXPECT_EQ(ran.exit_code, 0);
  std::istringstream lines(ran.output);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_TRUE(line.ends_with(" 12.000000 ms")) << line;
  EXPECT_EQ(count, 12) << ran.output;
}

TEST(WaitingCalls, ThoseThatAreNotReplacedAreToldOnceEach) {
  const Ran ran = run({waits_of_the_table, "real"});
  EXPECT_EQ(ran.exit_code, 0);
  std::vector<std::string> expected;
  for (const std::string_view name : calls_that_wait(exec::Waits::by_real_time))
    expected.push_back("'sh' calls " + std::string(name) +
                       ", which waits in real time: results may differ from run to run");
  std::vector<std::string> told = ran.told;
  std::ranges::sort(expected);
  std::ranges::sort(told);
  EXPECT_EQ(told, expected);
}

// The functions that a library defines, by its table of symbols.
std::set<std::string> functions_of(const std::string& library) {
  const Ended ended = run_to_end({"nm", "-D", "--defined-only", library});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  std::set<std::string> names;
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string address;
    std::string kind;
    std::string name;
    words >> address >> kind >> name;
    if (kind == "A" || name.ends_with("GLIBC_PRIVATE")) continue;
    names.insert(name.substr(0, name.find('@')));
  }
  return names;
}

TEST(WaitingCalls, TheTableHasTheCallsOfTheCLibraryByTheirNames) {
  Dl_info library{};
  ASSERT_NE(::dladdr(reinterpret_cast<const void*>(&::nanosleep), &library), 0);
  const std::regex waits(
      "_*(sleep|usleep|nanosleep|.*_(nano)?sleep|p?poll(_chk)?|p?select|epoll_p?wait2?|wait|.*_(timed|clock)?wait|"
      ".*_(timed|clock)(rd|wr)?lock|.*_(timed|clock|try)?join(_np)?|wait(pid|id|3|4)|sig(timed)?wait(info)?|"
      "(xpg_)?sigpause|.*suspend(64)?|pause|u?alarm|setitimer|timer(fd)?_settime|readv?(_chk)?|recv(m?msg|from)?(_chk)?"
      "|"
      "accept4?|mq_timed.*|.*timedop|syscall)");
  std::set<std::string> expected;
  for (const std::string& name : functions_of(library.dli_fname))
    if (std::regex_match(name, waits)) expected.insert(name);
  std::set<std::string> table;
  for (const exec::WaitingCall& call : exec::waiting_calls)
    if (call.name.find('(') == std::string_view::npos) table.emplace(call.name);
  EXPECT_EQ(table, expected);
  const std::set<std::string> replaced = functions_of(COHORT_BUILD_DIR "/lib/cohort/libcohort-exec.so");
  for (const exec::WaitingCall& call : exec::waiting_calls) {
    if (call.waits == exec::Waits::for_others) continue;
    EXPECT_TRUE(replaced.contains(std::string(call.name.substr(0, call.name.find('('))))) << call.name;
  }
}

}  // namespace
}  // namespace cohort::test
