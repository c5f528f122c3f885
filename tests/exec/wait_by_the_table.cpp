// SPDX-License-Identifier: Apache-2.0

// Makes each call of tools/exec/waiting_calls.hpp that has a time limit, and prints how long it took by the program's
// clock: 20 ms, or 1 s if it takes seconds. With "ended" waits for locks that another thread releases after 12 ms, and
// for signals and messages that it sends. With "real" makes those that are not replaced, twice.

#include <aio.h>
#include <mqueue.h>
#include <netdb.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/sem.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <threads.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

extern "C" {
int __nanosleep(const timespec*, timespec*);
int __poll(pollfd*, nfds_t, int);
int __poll_chk(pollfd*, nfds_t, int, std::size_t);
int __ppoll_chk(pollfd*, nfds_t, const timespec*, const sigset_t*, std::size_t);
int __select(int, fd_set*, fd_set*, fd_set*, timeval*);
ssize_t __read(int, void*, std::size_t);
ssize_t __read_chk(int, void*, std::size_t, std::size_t);
ssize_t __recv_chk(int, void*, std::size_t, std::size_t, int);
ssize_t __recvfrom_chk(int, void*, std::size_t, std::size_t, int, sockaddr*, socklen_t*);
}

namespace {

using namespace std::chrono_literals;

const timespec time_limit{0, 20'000'000};

std::int64_t now(clockid_t clock = CLOCK_MONOTONIC) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

timespec limit(clockid_t clock = CLOCK_REALTIME, std::int64_t nanoseconds = 20'000'000) {
  const std::int64_t at = now(clock) + nanoseconds;
  return {at / 1'000'000'000, at % 1'000'000'000};
}

template <class Wait>
void measure(const char* name, const Wait& wait) {
  const std::int64_t begin = now();
  wait();
  const std::int64_t took = now() - begin;
  std::printf("%s %ld.%06ld ms\n", name, static_cast<long>(took / 1'000'000), static_cast<long>(took % 1'000'000));
}

void sleep_and_poll() {
  measure("sleep", [] { ::sleep(1); });
  measure("usleep", [] { ::usleep(20'000); });
  measure("nanosleep", [] { ::nanosleep(&time_limit, nullptr); });
  measure("__nanosleep", [] { ::__nanosleep(&time_limit, nullptr); });
  measure("clock_nanosleep", [] { ::clock_nanosleep(CLOCK_MONOTONIC, 0, &time_limit, nullptr); });
  measure("thrd_sleep", [] { ::thrd_sleep(&time_limit, nullptr); });
  timeval time{0, 20'000};
  measure("poll", [] { ::poll(nullptr, 0, 20); });
  measure("__poll", [] { ::__poll(nullptr, 0, 20); });
  measure("__poll_chk", [] { ::__poll_chk(nullptr, 0, 20, 0); });
  measure("ppoll", [] { ::ppoll(nullptr, 0, &time_limit, nullptr); });
  measure("__ppoll_chk", [] { ::__ppoll_chk(nullptr, 0, &time_limit, nullptr, 0); });
  measure("select", [&] { ::select(0, nullptr, nullptr, nullptr, &time); });
  time = {0, 20'000};
  measure("__select", [&] { ::__select(0, nullptr, nullptr, nullptr, &time); });
  measure("pselect", [] { ::pselect(0, nullptr, nullptr, nullptr, &time_limit, nullptr); });
  const int queue = ::epoll_create1(0);
  epoll_event event{};
  measure("epoll_wait", [&] { ::epoll_wait(queue, &event, 1, 20); });
  measure("epoll_pwait", [&] { ::epoll_pwait(queue, &event, 1, 20, nullptr); });
  measure("epoll_pwait2", [&] { ::epoll_pwait2(queue, &event, 1, &time_limit, nullptr); });
}

void receive() {
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) != 0) return;
  const timeval time{0, 20'000};
  ::setsockopt(pair[0], SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
  char byte = 0;
  iovec part{&byte, 1};
  mmsghdr message{};
  message.msg_hdr.msg_iov = &part;
  message.msg_hdr.msg_iovlen = 1;
  measure("read", [&] { return ::read(pair[0], &byte, 1); });
  measure("__read", [&] { return ::__read(pair[0], &byte, 1); });
  measure("__read_chk", [&] { return ::__read_chk(pair[0], &byte, 1, 1); });
  measure("readv", [&] { return ::readv(pair[0], &part, 1); });
  measure("recv", [&] { return ::recv(pair[0], &byte, 1, 0); });
  measure("__recv_chk", [&] { return ::__recv_chk(pair[0], &byte, 1, 1, 0); });
  measure("recvfrom", [&] { return ::recvfrom(pair[0], &byte, 1, 0, nullptr, nullptr); });
  measure("__recvfrom_chk", [&] { return ::__recvfrom_chk(pair[0], &byte, 1, 1, 0, nullptr, nullptr); });
  measure("recvmsg", [&] { return ::recvmsg(pair[0], &message.msg_hdr, 0); });
  measure("recvmmsg", [&] { return ::recvmmsg(pair[0], &message, 1, 0, nullptr); });
  const int server = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};  // an address that the kernel chooses
  address.sun_family = AF_UNIX;
  if (::bind(server, reinterpret_cast<sockaddr*>(&address), sizeof(sa_family_t)) != 0 || ::listen(server, 1) != 0)
    std::perror("listen");
  ::setsockopt(server, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
  measure("accept", [&] { return ::accept(server, nullptr, nullptr); });
  measure("accept4", [&] { return ::accept4(server, nullptr, nullptr, 0); });
}

void wait_for_conditions() {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  ::pthread_mutex_lock(&mutex);
  measure("pthread_cond_timedwait", [&] {
    const timespec end = limit();
    ::pthread_cond_timedwait(&condition, &mutex, &end);
  });
  measure("pthread_cond_clockwait", [&] {
    const timespec end = limit(CLOCK_MONOTONIC);
    ::pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &end);
  });
  mtx_t plain;
  cnd_t signal;
  ::mtx_init(&plain, mtx_plain);
  ::cnd_init(&signal);
  ::mtx_lock(&plain);
  measure("cnd_timedwait", [&] {
    const timespec end = limit();
    ::cnd_timedwait(&signal, &plain, &end);
  });
}

// Locks and semaphores that are taken. `release` does so from another thread, after 12 ms; without it, never.
struct Taken {
  sem_t semaphore{};
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  mtx_t plain{};
  pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
};

template <class Take, class Hold, class Release>
void take(const char* name, bool is_released, const Take& call, const Hold& hold, const Release& release) {
  std::thread holder([&] {
    hold();
    std::this_thread::sleep_for(is_released ? 32ms : 60ms);
    release();
  });
  std::this_thread::sleep_for(20ms);
  measure(name, call);
  holder.join();
}

void take_locks(bool is_released) {
  Taken taken;
  const std::int64_t time = is_released ? 1'000'000'000 : 20'000'000;
  ::sem_init(&taken.semaphore, 0, 0);
  ::mtx_init(&taken.plain, mtx_timed);
  const auto try_it = [&](const char* name, const auto& call, const auto& hold, const auto& release) {
    take(name, is_released, call, hold, release);
  };
  const auto none = [] {};
  const auto post = [&] { is_released ? ::sem_post(&taken.semaphore) : 0; };
  const auto hold_mutex = [&] { ::pthread_mutex_lock(&taken.mutex); };
  const auto release_mutex = [&] { ::pthread_mutex_unlock(&taken.mutex); };
  const auto write_lock = [&] { ::pthread_rwlock_wrlock(&taken.lock); };
  const auto unlock = [&] { ::pthread_rwlock_unlock(&taken.lock); };
  const auto by = [&](const auto& call, clockid_t clock, const auto& undo) {
    return [&call, &undo, clock, time] {
      const timespec end = limit(clock, time);
      if (call(end) == 0) undo();
    };
  };
  const auto sem_timed = [&](const timespec& end) { return ::sem_timedwait(&taken.semaphore, &end); };
  try_it("sem_timedwait", by(sem_timed, CLOCK_REALTIME, none), none, post);
  const auto sem_clock = [&](const timespec& end) { return ::sem_clockwait(&taken.semaphore, CLOCK_MONOTONIC, &end); };
  try_it("sem_clockwait", by(sem_clock, CLOCK_MONOTONIC, none), none, post);
  const auto timed = [&](const timespec& end) { return ::pthread_mutex_timedlock(&taken.mutex, &end); };
  try_it("pthread_mutex_timedlock", by(timed, CLOCK_REALTIME, release_mutex), hold_mutex, release_mutex);
  const auto clocked = [&](const timespec& end) {
    return ::pthread_mutex_clocklock(&taken.mutex, CLOCK_MONOTONIC, &end);
  };
  try_it("pthread_mutex_clocklock", by(clocked, CLOCK_MONOTONIC, release_mutex), hold_mutex, release_mutex);
  const auto release_plain = [&] { ::mtx_unlock(&taken.plain); };
  const auto plain = [&](const timespec& end) { return ::mtx_timedlock(&taken.plain, &end); };
  try_it(
      "mtx_timedlock", by(plain, CLOCK_REALTIME, release_plain), [&] { ::mtx_lock(&taken.plain); }, release_plain);
  const auto read_timed = [&](const timespec& end) { return ::pthread_rwlock_timedrdlock(&taken.lock, &end); };
  try_it("pthread_rwlock_timedrdlock", by(read_timed, CLOCK_REALTIME, unlock), write_lock, unlock);
  const auto read_clock = [&](const timespec& end) {
    return ::pthread_rwlock_clockrdlock(&taken.lock, CLOCK_MONOTONIC, &end);
  };
  try_it("pthread_rwlock_clockrdlock", by(read_clock, CLOCK_MONOTONIC, unlock), write_lock, unlock);
  const auto write_timed = [&](const timespec& end) { return ::pthread_rwlock_timedwrlock(&taken.lock, &end); };
  try_it("pthread_rwlock_timedwrlock", by(write_timed, CLOCK_REALTIME, unlock), write_lock, unlock);
  const auto write_clock = [&](const timespec& end) {
    return ::pthread_rwlock_clockwrlock(&taken.lock, CLOCK_MONOTONIC, &end);
  };
  try_it("pthread_rwlock_clockwrlock", by(write_clock, CLOCK_MONOTONIC, unlock), write_lock, unlock);
}

mqd_t queue_of_one_message() {
  mq_attr attributes{};
  attributes.mq_maxmsg = 1;
  attributes.mq_msgsize = 1;
  const std::string name = "/wait_by_the_table_" + std::to_string(::getpid());
  const mqd_t queue = ::mq_open(name.c_str(), O_CREAT | O_RDWR, 0600, &attributes);
  if (queue == static_cast<mqd_t>(-1)) std::perror("mq_open");
  ::mq_unlink(name.c_str());
  return queue;
}

void wait_for_signals_and_messages(bool is_ended) {
  const std::int64_t time = is_ended ? 1'000'000'000 : 20'000'000;
  const auto after_12_ms = [&](const auto& act) {
    return std::thread([&act, is_ended] {
      if (!is_ended) return;
      std::this_thread::sleep_for(12ms);
      act();
    });
  };
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  const timespec length{time / 1'000'000'000, time % 1'000'000'000};
  const auto send_signal = [] { ::kill(::getpid(), SIGUSR1); };
  std::thread one = after_12_ms(send_signal);
  measure("sigtimedwait", [&] { ::sigtimedwait(&signals, nullptr, &length); });
  one.join();
  const mqd_t queue = queue_of_one_message();
  char byte = 0;
  const auto send = [&] { ::mq_send(queue, "x", 1, 0); };
  one = after_12_ms(send);
  measure("mq_timedreceive", [&] {
    const timespec end = limit(CLOCK_REALTIME, time);
    ::mq_timedreceive(queue, &byte, 1, nullptr, &end);
  });
  one.join();
  send();
  const auto receive_one = [&] { ::mq_receive(queue, &byte, 1, nullptr); };
  one = after_12_ms(receive_one);
  measure("mq_timedsend", [&] {
    const timespec end = limit(CLOCK_REALTIME, time);
    ::mq_timedsend(queue, "x", 1, 0, &end);
  });
  one.join();
}

void wait_for_timers() {
  ::signal(SIGALRM, [](int) {});
  measure("alarm", [] {
    ::alarm(1);
    ::pause();
  });
  measure("ualarm", [] {
    ::ualarm(20'000, 0);
    ::pause();
  });
  measure("setitimer", [] {
    const itimerval once{{}, {0, 20'000}};
    ::setitimer(ITIMER_REAL, &once, nullptr);
    ::pause();
  });
  const itimerspec once{{}, time_limit};
  measure("timer_settime", [&] {
    timer_t timer{};
    ::timer_create(CLOCK_MONOTONIC, nullptr, &timer);
    ::timer_settime(timer, 0, &once, nullptr);
    ::pause();
  });
  measure("timerfd_settime", [&] {
    const int timer = ::timerfd_create(CLOCK_MONOTONIC, 0);
    ::timerfd_settime(timer, 0, &once, nullptr);
    std::uint64_t count = 0;
    return ::read(timer, &count, sizeof count);
  });
}

void wait_by_real_time() {
  const timespec short_time{0, 1'000'000};
  int ends[2];
  if (::pipe(ends) != 0) return;
  std::thread other([&] {
    char byte = 0;
    if (::read(ends[0], &byte, 1) != 1) std::perror("read");
  });
  timespec end = limit(CLOCK_REALTIME, 1'000'000);
  ::pthread_timedjoin_np(other.native_handle(), nullptr, &end);
  end = limit(CLOCK_MONOTONIC, 1'000'000);
  ::pthread_clockjoin_np(other.native_handle(), nullptr, CLOCK_MONOTONIC, &end);
  const int set = ::semget(IPC_PRIVATE, 1, 0600);
  sembuf down{0, -1, 0};
  ::semtimedop(set, &down, 1, &short_time);
  ::semctl(set, 0, IPC_RMID);
  const aiocb* none[1] = {nullptr};
  ::aio_suspend(none, 1, &short_time);
  const aiocb64* none_64[1] = {nullptr};
  ::aio_suspend64(none_64, 1, &short_time);
  const gaicb* no_name[1] = {nullptr};
  ::gai_suspend(no_name, 1, &short_time);
  int pair[2];
  const timeval time{1, 0};
  if (::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) == 0)
    ::setsockopt(pair[0], SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
  ::syscall(SYS_ppoll, nullptr, 0, &short_time, nullptr, 0);
  if (::write(ends[1], "x", 1) != 1) std::perror("write");
  other.join();
}

}  // namespace

int main(int count, char** arguments) {
  const std::string what = count > 1 ? arguments[1] : "";
  if (what == "real") {
    wait_by_real_time();
    wait_by_real_time();
    return 0;
  }
  const bool is_ended = what == "ended";
  take_locks(is_ended);
  wait_for_signals_and_messages(is_ended);
  if (is_ended) return 0;
  sleep_and_poll();
  receive();
  wait_for_conditions();
  wait_for_timers();
  return 0;
}
