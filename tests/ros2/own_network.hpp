// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace cohort::test {

namespace detail {

inline bool write_text(const char* file, const std::string& text) {
  const int descriptor = open(file, O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_written = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(descriptor);
  return is_written;
}

inline bool enter_own_network() {
  const std::string user = std::to_string(getuid()), group = std::to_string(getgid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET | CLONE_NEWNS) != 0) return false;
  return write_text("/proc/self/setgroups", "deny") && write_text("/proc/self/uid_map", "0 " + user + " 1") &&
         write_text("/proc/self/gid_map", "0 " + group + " 1") && mount("none", "/dev/shm", "tmpfs", 0, nullptr) == 0 &&
         std::system("ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo") == 0;
}

}  // namespace detail

/// Moves this process, and all that it starts from now on, into a network of its own with multicast on lo and with its
/// own shared memory. Every domain of DDS is free there. Call it before there are other threads. Returns false if the
/// machine does not allow it.
inline bool has_own_network() {
  static const bool has = detail::enter_own_network();
  return has;
}

}  // namespace cohort::test
