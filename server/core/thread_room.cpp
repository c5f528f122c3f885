// SPDX-License-Identifier: Apache-2.0
#include "server/core/thread_room.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <system_error>
#include <thread>
#include <vector>

#include "server/core/control_groups.hpp"

namespace cohort {
namespace {

// Returns the limits that apply to this process, with the way to look each of them up.
std::string limits_text() {
  std::string text;
  const auto add = [&](const std::string& limit) { text += (text.empty() ? "" : ", or ") + limit; };
  rlimit of_user{};
  if (getrlimit(RLIMIT_NPROC, &of_user) == 0 && of_user.rlim_cur != RLIM_INFINITY)
    add(std::to_string(of_user.rlim_cur) + " processes and threads of this user ('ulimit -u')");
  for (const ControlGroup& group : control_groups("pids")) {
    const std::filesystem::path file = group.folder / "pids.max";
    std::string most;
    if (std::ifstream(file) >> most && most != "max")
      add(most + " in the control group or container (" + file.string() + ")");
  }
  std::string most;
  if (text.empty() && std::ifstream("/proc/sys/kernel/threads-max") >> most)
    add(most + " on this machine (/proc/sys/kernel/threads-max), or memory");
  return text;
}

// Returns a number that rises by one with each thread of this process.
nlink_t count_threads() {
  struct stat facts {};
  return stat("/proc/self/task", &facts) == 0 ? facts.st_nlink : 0;
}

// The limits count a thread for a moment after it has been joined.
void await_ends_of_threads(nlink_t count_before) {
  constexpr int most_looks = 1000;
  for (int i = 0; i < most_looks && count_threads() > count_before; ++i) std::this_thread::yield();
}

}  // namespace

ThreadLimit::ThreadLimit(const std::string& what)
    : std::runtime_error("cannot start " + what + ": the limit is reached; it is " + limits_text() +
                         ". Raise it, end other processes, or use fewer threads and processes ('--threads 1', "
                         "'--controllers inprocess')") {}

void expect_room_for_threads(unsigned count) {
  const nlink_t count_before = count_threads();
  std::atomic<bool> is_over{false};
  std::vector<std::thread> threads;
  threads.reserve(count);
  bool has_room = true;
  try {
    while (threads.size() < count) threads.emplace_back([&] { is_over.wait(false); });
  } catch (const std::system_error&) {
    has_room = false;
  }
  is_over = true;
  is_over.notify_all();
  for (std::thread& thread : threads) thread.join();
  await_ends_of_threads(count_before);
  if (!has_room) throw ThreadLimit(count == 1 ? "a thread" : std::to_string(count) + " threads");
}

bool is_thread_limit(const std::exception& error) {
  const auto* const of_system = dynamic_cast<const std::system_error*>(&error);
  return dynamic_cast<const ThreadLimit*>(&error) != nullptr ||
         (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again);
}

}  // namespace cohort
