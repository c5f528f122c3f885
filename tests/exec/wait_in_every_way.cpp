// SPDX-License-Identifier: Apache-2.0

// An ordinary program that waits in every way that it can and prints how long each took by its own clocks.

#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace std::chrono_literals;

volatile std::sig_atomic_t signals = 0;
void count_signal(int) { signals = signals + 1; }

std::int64_t now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

timespec in(clockid_t clock, std::int64_t nanoseconds) {
  timespec time{};
  ::clock_gettime(clock, &time);
  const std::int64_t at = time.tv_sec * 1'000'000'000 + time.tv_nsec + nanoseconds;
  return {at / 1'000'000'000, at % 1'000'000'000};
}

template <class Wait>
void measure(const char* name, const Wait& wait) {
  const std::int64_t begin = now();
  const long result = static_cast<long>(wait());
  const std::int64_t took = now() - begin;
  std::printf("%s %ld.%06ld ms, %ld\n", name, static_cast<long>(took / 1'000'000), static_cast<long>(took % 1'000'000),
              result);
}

void sleep_in_every_way() {
  measure("sleep", [] { return ::sleep(2); });
  measure("usleep", [] { return ::usleep(1500); });
  measure("nanosleep", [] {
    const timespec time{0, 250'000};
    return ::nanosleep(&time, nullptr);
  });
  measure("clock_nanosleep_to_a_date", [] {
    const timespec time = in(CLOCK_REALTIME, 3'000'000);
    return ::clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &time, nullptr);
  });
  measure("sleep_for", [] {
    std::this_thread::sleep_for(7ms);
    return 0;
  });
  measure("system_clock", [] {
    const auto begin = std::chrono::system_clock::now();
    std::this_thread::sleep_until(begin + 4ms);
    return (std::chrono::system_clock::now() - begin).count();
  });
  measure("steady_clock", [] {
    const auto begin = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(5ms);
    return (std::chrono::steady_clock::now() - begin).count();
  });
}

void poll_in_every_way() {
  int ends[2];
  if (::pipe(ends) != 0) return;
  measure("poll", [&] {
    pollfd polled{ends[0], POLLIN, 0};
    return ::poll(&polled, 1, 20);
  });
  measure("ppoll", [&] {
    const timespec time{0, 30'000'000};
    pollfd polled{ends[0], POLLIN, 0};
    return ::ppoll(&polled, 1, &time, nullptr);
  });
  measure("select", [&] {
    fd_set set;
    FD_ZERO(&set);
    FD_SET(ends[0], &set);
    timeval time{0, 40'000};
    return ::select(ends[0] + 1, &set, nullptr, nullptr, &time) * 100 + (FD_ISSET(ends[0], &set) ? 1 : 0);
  });
  const int queue = ::epoll_create1(0);
  epoll_event event{EPOLLIN, {}};
  ::epoll_ctl(queue, EPOLL_CTL_ADD, ends[0], &event);
  measure("epoll_wait", [&] { return ::epoll_wait(queue, &event, 1, 50); });
  // Another thread writes while this one polls.
  std::thread writer([&] {
    std::this_thread::sleep_for(12ms);
    if (::write(ends[1], "x", 1) != 1) std::perror("write");
  });
  measure("poll_that_is_ended", [&] {
    pollfd polled{ends[0], POLLIN, 0};
    return ::poll(&polled, 1, 1000);
  });
  writer.join();
  measure("epoll_wait_at_once", [&] { return ::epoll_wait(queue, &event, 1, 50); });
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) != 0) return;
  const timeval limit{0, 60'000};
  ::setsockopt(pair[0], SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  measure("recv", [&] {
    char byte = 0;
    return ::recv(pair[0], &byte, 1, 0);
  });
}

// Prints which of the polled descriptors are ready, and how much of the time is left.
void poll_with_results() {
  int first[2];
  int second[2];
  if (::pipe(first) != 0 || ::pipe(second) != 0) return;
  measure("poll_at_once", [&] {
    pollfd polled{first[0], POLLIN, 0};
    return ::poll(&polled, 1, 0);
  });
  const int queue = ::epoll_create1(0);
  epoll_event event{EPOLLIN, {.fd = 77}};
  ::epoll_ctl(queue, EPOLL_CTL_ADD, second[0], &event);
  measure("epoll_wait_for_nothing", [&] { return ::epoll_wait(queue, &event, 1, 0); });
  std::thread writer([&] {
    std::this_thread::sleep_for(12ms);
    if (::write(second[1], "x", 1) != 1) std::perror("write");
  });
  measure("poll_of_two", [&] {
    pollfd polled[2] = {{first[0], POLLIN, 0}, {second[0], POLLIN, 0}};
    const int count = ::poll(polled, 2, 1000);
    return count * 100 + (polled[0].revents == 0 ? 10 : 0) + (polled[1].revents == POLLIN ? 1 : 0);
  });
  writer.join();
  measure("epoll_pwait", [&] {
    epoll_event found{};
    return ::epoll_pwait(queue, &found, 1, 50, nullptr) * 100 + found.data.fd;
  });
  std::thread other([&] {
    std::this_thread::sleep_for(12ms);
    if (::write(first[1], "x", 1) != 1) std::perror("write");
  });
  measure("select_that_is_ended", [&] {
    fd_set set;
    FD_ZERO(&set);
    FD_SET(first[0], &set);
    timeval time{0, 40'000};
    return ::select(first[0] + 1, &set, nullptr, nullptr, &time) * 100'000 + time.tv_usec;
  });
  other.join();
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) != 0) return;
  const timeval limit{0, 60'000};
  ::setsockopt(pair[0], SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  measure("recv_at_once", [&] {
    char byte = 0;
    return ::recv(pair[0], &byte, 1, MSG_DONTWAIT);
  });
  std::thread sender([&] {
    std::this_thread::sleep_for(9ms);
    ::send(pair[1], "x", 1, 0);
  });
  measure("recv_that_is_ended", [&] {
    char byte = 0;
    return ::recv(pair[0], &byte, 1, 0);
  });
  sender.join();
}

void look_at_timers() {
  ::signal(SIGALRM, &count_signal);
  measure("alarm_that_is_taken_back", [] {
    ::alarm(5);
    std::this_thread::sleep_for(2s);
    return ::alarm(0);
  });
  measure("nanosleep_that_is_interrupted", [] {
    const itimerval once{{}, {0, 5'000}};
    ::setitimer(ITIMER_REAL, &once, nullptr);
    const timespec time{0, 20'000'000};
    timespec left{};
    return ::nanosleep(&time, &left) == -1 && errno == EINTR ? left.tv_nsec : -1;
  });
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  itimerspec setting{};
  ::timerfd_gettime(timer, &setting);
  std::printf("timerfd is off: %ld\n", setting.it_value.tv_nsec);
  const itimerspec every{{0, 7'000'000}, {0, 30'000'000}};
  ::timerfd_settime(timer, 0, &every, nullptr);
  std::this_thread::sleep_for(10ms);
  ::timerfd_gettime(timer, &setting);
  std::printf("timerfd has %ld left, every %ld\n", setting.it_value.tv_nsec, setting.it_interval.tv_nsec);
  std::uint64_t count = 0;
  std::printf("timerfd has not fired: %d\n", ::read(timer, &count, sizeof count) < 0 && errno == EAGAIN ? 1 : 0);
}

// One thread counts the milliseconds, and tells another one of each fifth; that one waits for at most three at a time.
void tell_each_other() {
  std::mutex mutex;
  std::condition_variable wake;
  int told = 0;
  std::string seen;
  const std::int64_t begin = now();
  std::thread teller([&] {
    for (int i = 1; i <= 20; ++i) {
      std::this_thread::sleep_for(1ms);
      if (i % 5 != 0) continue;
      const std::lock_guard lock(mutex);
      ++told;
      wake.notify_one();
    }
  });
  for (int heard = 0; heard < 4;) {
    std::unique_lock lock(mutex);
    const bool in_time = wake.wait_for(lock, 3ms, [&] { return told > heard; });
    if (in_time) ++heard;
    seen += " " + std::to_string((now() - begin) / 1'000'000) + (in_time ? "!" : "");
  }
  teller.join();
  std::printf("told at%s\n", seen.c_str());
}

void use_timers() {
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, 0);
  const itimerspec every{{0, 10'000'000}, {0, 5'000'000}};
  ::timerfd_settime(timer, 0, &every, nullptr);
  for (int i = 0; i < 3; ++i)
    measure("timerfd", [&] {
      std::uint64_t count = 0;
      return ::read(timer, &count, sizeof count) == sizeof count ? static_cast<long>(count) : -1;
    });
  std::this_thread::sleep_for(35ms);
  measure("timerfd_that_was_missed", [&] {
    std::uint64_t count = 0;
    return ::read(timer, &count, sizeof count) == sizeof count ? static_cast<long>(count) : -1;
  });
  ::signal(SIGALRM, &count_signal);
  measure("alarm", [] {
    ::alarm(1);
    ::pause();
    return signals;
  });
  measure("setitimer", [] {
    const itimerval every_10_ms{{0, 10'000}, {0, 10'000}};
    const itimerval off{};
    ::setitimer(ITIMER_REAL, &every_10_ms, nullptr);
    for (int i = 0; i < 3; ++i) ::pause();
    ::setitimer(ITIMER_REAL, &off, nullptr);
    return signals;
  });
  measure("timer_create", [] {
    timer_t id{};
    ::timer_create(CLOCK_REALTIME, nullptr, &id);
    const itimerspec once{{}, {0, 15'000'000}};
    ::timer_settime(id, 0, &once, nullptr);
    ::pause();
    ::timer_delete(id);
    return signals;
  });
}

void wait_for_threads() {
  std::mutex mutex;
  std::condition_variable wake;
  bool is_set = false;
  measure("wait_for", [&] {
    std::unique_lock lock(mutex);
    return wake.wait_for(lock, 25ms, [&] { return is_set; });
  });
  std::thread setter([&] {
    std::this_thread::sleep_for(8ms);
    const std::lock_guard lock(mutex);
    is_set = true;
    wake.notify_one();
  });
  measure("wait_for_that_is_ended", [&] {
    std::unique_lock lock(mutex);
    return wake.wait_for(lock, 1s, [&] { return is_set; });
  });
  setter.join();
  measure("pthread_cond_timedwait", [] {
    pthread_mutex_t plain = PTHREAD_MUTEX_INITIALIZER;
    pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
    const timespec limit = in(CLOCK_REALTIME, 9'000'000);
    ::pthread_mutex_lock(&plain);
    const int error = ::pthread_cond_timedwait(&condition, &plain, &limit);
    ::pthread_mutex_unlock(&plain);
    return error == ETIMEDOUT;
  });
  sem_t semaphore;
  ::sem_init(&semaphore, 0, 0);
  measure("sem_timedwait", [&] {
    const timespec limit = in(CLOCK_REALTIME, 11'000'000);
    return ::sem_timedwait(&semaphore, &limit);
  });
  std::thread poster([&] {
    std::this_thread::sleep_for(6ms);
    ::sem_post(&semaphore);
  });
  measure("sem_clockwait_that_is_ended", [&] {
    const timespec limit = in(CLOCK_MONOTONIC, 500'000'000);
    return ::sem_clockwait(&semaphore, CLOCK_MONOTONIC, &limit);
  });
  poster.join();
  std::promise<int> promise;
  measure("future", [&] { return promise.get_future().wait_for(13ms) == std::future_status::timeout; });
}

void start_a_process() {
  measure("child", [] {
    const pid_t child = ::fork();
    if (child == 0) {
      std::this_thread::sleep_for(70ms);
      ::_exit(5);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  });
  measure("shell", [] { return WEXITSTATUS(std::system("sleep 0.08; exit 6")); });
}

// Threads that wake at the same time, and add to what they share without a lock.
void race() {
  std::uint64_t shared = 1;
  std::vector<std::thread> threads;
  for (std::uint64_t i = 0; i < 8; ++i)
    threads.emplace_back([&shared, i] {
      for (int k = 0; k < 50; ++k) {
        std::this_thread::sleep_for(1ms);
        shared = shared * 31 + i;
      }
    });
  for (std::thread& thread : threads) thread.join();
  std::printf("race %016lx\n", shared);
}

void spin() {
  measure("spin", [] {
    const std::int64_t until = now() + 10'000'000;
    long reads = 0;
    while (now() < until) ++reads;
    return reads;
  });
}

}  // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("begins at %ld\n", static_cast<long>(now()));
  sleep_in_every_way();
  poll_in_every_way();
  poll_with_results();
  use_timers();
  look_at_timers();
  tell_each_other();
  wait_for_threads();
  start_a_process();
  race();
  spin();
  return 4;
}
