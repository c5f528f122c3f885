// SPDX-License-Identifier: Apache-2.0

// Receiving from sockets, with the time limit that each may have.

#include <errno.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

// How long a socket waits for what it receives (SO_RCVTIMEO), by descriptor; 0: for ever. The kernel has it too, for
// calls that are not replaced, such as fread.
constexpr int most_descriptors = 4096;
std::atomic<std::int64_t> receive_times[most_descriptors];

bool has_receive_time(int descriptor) {
  return page() != nullptr && descriptor >= 0 && descriptor < most_descriptors && receive_times[descriptor] != 0;
}

// Returns false if nothing came within the socket's time.
bool await_data(const void* caller, int descriptor, int flags = 0) {
  if ((flags & MSG_DONTWAIT) != 0 || !has_receive_time(descriptor) || !is_virtual_for(caller)) return true;
  pollfd polled{descriptor, POLLIN, 0};
  if (poll_until(&polled, 1, later(now(), receive_times[descriptor]), nullptr) > 0) return true;
  errno = EAGAIN;
  return false;
}

// One that finds nothing polls.
template <class Result>
Result counted(const void* caller, Result result) {
  if (result >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK) || !is_virtual_for(caller)) return result;
  const int error = errno;
  count_spin();
  errno = error;
  return result;
}

}  // namespace

COHORT_REPLACES int setsockopt(int descriptor, int level, int name, const void* value, socklen_t size) noexcept {
  COHORT_NEXT(setsockopt);
  if (level == SOL_SOCKET && name == SO_SNDTIMEO && is_virtual_for(COHORT_CALLER))
    note_real_time<"setsockopt(SO_SNDTIMEO)">();
  const bool is_time = level == SOL_SOCKET && name == SO_RCVTIMEO && value != nullptr && size >= sizeof(timeval);
  if (!is_time || descriptor < 0 || descriptor >= most_descriptors || !is_virtual_for(COHORT_CALLER))
    return real(descriptor, level, name, value, size);
  const int result = real(descriptor, level, name, value, size);
  if (result == 0) receive_times[descriptor] = nanoseconds(*static_cast<const timeval*>(value));
  return result;
}

COHORT_REPLACES int close(int descriptor) {
  COHORT_NEXT(close);
  if (descriptor >= 0 && descriptor < most_descriptors) receive_times[descriptor] = 0;
  return real(descriptor);
}

COHORT_REPLACES ssize_t read(int descriptor, void* bytes, std::size_t size) {
  COHORT_NEXT(read);
  if (!await_data(COHORT_CALLER, descriptor)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size));
}
COHORT_REPLACES ssize_t __read(int, void*, std::size_t) __attribute__((alias("read")));

COHORT_REPLACES ssize_t readv(int descriptor, const iovec* parts, int count) {
  COHORT_NEXT(readv);
  if (!await_data(COHORT_CALLER, descriptor)) return -1;
  return counted(COHORT_CALLER, real(descriptor, parts, count));
}

COHORT_REPLACES ssize_t recv(int descriptor, void* bytes, std::size_t size, int flags) {
  COHORT_NEXT(recv);
  if (!await_data(COHORT_CALLER, descriptor, flags)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size, flags));
}

COHORT_REPLACES ssize_t recvfrom(int descriptor, void* bytes, std::size_t size, int flags, sockaddr* from,
                                 socklen_t* length) {
  COHORT_NEXT(recvfrom);
  if (!await_data(COHORT_CALLER, descriptor, flags)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size, flags, from, length));
}

COHORT_REPLACES ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
  COHORT_NEXT(recvmsg);
  if (!await_data(COHORT_CALLER, descriptor, flags)) return -1;
  return counted(COHORT_CALLER, real(descriptor, message, flags));
}

// As the kernel does it: the time limit is looked at after each message only.
COHORT_REPLACES int recvmmsg(int descriptor, mmsghdr* messages, unsigned count, int flags, timespec* time) {
  COHORT_NEXT(recvmmsg);
  const void* const caller = COHORT_CALLER;
  if (!is_virtual_for(caller) || count == 0) return real(descriptor, messages, count, flags, time);
  const std::int64_t deadline = time != nullptr ? later(now(), nanoseconds(*time)) : never;
  unsigned received = 0;
  int result = 0;
  do {
    int how = flags & ~MSG_WAITFORONE;
    if (received > 0 && (flags & MSG_WAITFORONE) != 0) how |= MSG_DONTWAIT;
    result = await_data(caller, descriptor, how) ? real(descriptor, messages + received, 1, how, nullptr) : -1;
    if (result > 0) ++received;
  } while (result > 0 && received < count && now() < deadline);
  if (time != nullptr) *time = to_timespec(deadline > now() ? deadline - now() : 0);
  return received > 0 ? static_cast<int>(received) : counted(caller, result);
}

COHORT_REPLACES int accept(int descriptor, sockaddr* from, socklen_t* length) {
  COHORT_NEXT(accept);
  if (!await_data(COHORT_CALLER, descriptor)) return -1;
  return counted(COHORT_CALLER, real(descriptor, from, length));
}

COHORT_REPLACES int accept4(int descriptor, sockaddr* from, socklen_t* length, int flags) {
  COHORT_NEXT(accept4);
  if (!await_data(COHORT_CALLER, descriptor)) return -1;
  return counted(COHORT_CALLER, real(descriptor, from, length, flags));
}

// Calls of programs that were compiled with _FORTIFY_SOURCE.
COHORT_REPLACES ssize_t __read_chk(int descriptor, void* bytes, std::size_t size, std::size_t room) {
  const auto real = next_of<"__read_chk", ssize_t (*)(int, void*, std::size_t, std::size_t)>();
  if (!await_data(COHORT_CALLER, descriptor)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size, room));
}

COHORT_REPLACES ssize_t __recv_chk(int descriptor, void* bytes, std::size_t size, std::size_t room, int flags) {
  const auto real = next_of<"__recv_chk", ssize_t (*)(int, void*, std::size_t, std::size_t, int)>();
  if (!await_data(COHORT_CALLER, descriptor, flags)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size, room, flags));
}

COHORT_REPLACES ssize_t __recvfrom_chk(int descriptor, void* bytes, std::size_t size, std::size_t room, int flags,
                                       sockaddr* from, socklen_t* length) {
  using Call = ssize_t (*)(int, void*, std::size_t, std::size_t, int, sockaddr*, socklen_t*);
  const auto real = next_of<"__recvfrom_chk", Call>();
  if (!await_data(COHORT_CALLER, descriptor, flags)) return -1;
  return counted(COHORT_CALLER, real(descriptor, bytes, size, room, flags, from, length));
}
