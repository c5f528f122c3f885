// SPDX-License-Identifier: Apache-2.0

// A cable between two network namespaces that loses packets: lossy_link NAMESPACE NAMESPACE LOSS SEED. Makes a network
// interface `cable` in each (of `ip netns`), and carries packets between them in both directions. It drops a share LOSS
// (0 to 1) of them, chosen at random. Prints "up" when the interfaces exist; runs until it is killed.

#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

namespace {

[[noreturn]] void give_up(const std::string& what) {
  std::fprintf(stderr, "lossy_link: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(1);
}

// Returns a descriptor for the packets of a new interface in a namespace.
int open_end(const std::string& name) {
  const int space = open(("/run/netns/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  if (space < 0 || setns(space, CLONE_NEWNET) != 0) give_up("cannot enter the namespace " + name);
  close(space);
  const int end = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (end < 0) give_up("/dev/net/tun");
  ifreq request{};
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  std::strcpy(request.ifr_name, "cable");
  if (ioctl(end, TUNSETIFF, &request) != 0) give_up("cannot make an interface");
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::array<int, 2> ends = {open_end(argv[1]), open_end(argv[2])};
  std::bernoulli_distribution is_lost(std::atof(argv[3]));
  std::mt19937_64 random(std::strtoull(argv[4], nullptr, 10));
  std::puts("up");
  std::fflush(stdout);
  std::array<char, 65536> packet{};
  for (;;) {
    std::array<pollfd, 2> polled = {pollfd{ends[0], POLLIN, 0}, pollfd{ends[1], POLLIN, 0}};
    if (poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) give_up("poll");
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (ssize_t size = 0; (size = read(ends.at(i), packet.data(), packet.size())) > 0;)
        // Packets that the other end has no room for are also lost.
        if (!is_lost(random)) [[maybe_unused]]
          const auto written = write(ends.at(1 - i), packet.data(), static_cast<std::size_t>(size));
    }
  }
}
