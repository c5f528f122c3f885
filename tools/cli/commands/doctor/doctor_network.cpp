// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include "idl/dds/survey.hpp"
#include "tools/cli/commands/doctor/doctor.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds patience_with_server{4};
constexpr std::chrono::milliseconds patience_with_kernel{500};

struct Interface {
  std::string name;
  std::string address;
  bool is_loopback = false;
};

std::vector<Interface> interfaces_that_are_up() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, freeifaddrs);
  std::vector<Interface> interfaces;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET || (entry->ifa_flags & IFF_UP) == 0)
      continue;
    char text[INET_ADDRSTRLEN] = {};
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr, text, sizeof text);
    interfaces.push_back({entry->ifa_name, text, (entry->ifa_flags & IFF_LOOPBACK) != 0});
  }
  return interfaces;
}

class Udp {
 public:
  Udp() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  Udp(const Udp&) = delete;
  Udp& operator=(const Udp&) = delete;
  ~Udp() { close(descriptor_); }

  bool bind(const sockaddr_in& to) const {
    return ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  bool connect(const sockaddr_in& to) const {
    return ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  // Returns 0 or errno, which may be the error of the previous datagram if the other side has reported it meanwhile.
  int send() const { return ::send(descriptor_, "?", 1, 0) < 0 ? errno : 0; }
  bool receives_within(std::chrono::milliseconds patience) const {
    pollfd watched{descriptor_, POLLIN, 0};
    return poll(&watched, 1, static_cast<int>(patience.count())) == 1;
  }
  // Returns the pending error of the socket; 0 if there is none.
  int error() const {
    int error = 0;
    socklen_t size = sizeof error;
    getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
  }

 private:
  int descriptor_;
};

std::optional<sockaddr_in> socket_address(const std::string& address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1) return std::nullopt;
  return result;
}

// Returns the inodes of the sockets of a UDP port. The kernel lists them as `sl  local_address rem_address … inode`,
// with addresses as HEX:PORT.
std::vector<std::string> sockets_of_port(std::uint16_t port) {
  std::vector<std::string> inodes;
  for (const char* file : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::istringstream fields(line);
      std::string field, local, inode;
      fields >> field >> local;
      for (int i = 0; i < 8; ++i) fields >> inode;
      if (local.ends_with(fmt::format(":{:04X}", port))) inodes.push_back(inode);
    }
  }
  return inodes;
}

// Returns whether the kernel may use the port as an ephemeral port.
bool is_ephemeral(std::uint16_t port) {
  std::ifstream in("/proc/sys/net/ipv4/ip_local_port_range");
  unsigned first = 0, last = 0;
  return in >> first >> last && port >= first && port <= last;
}

bool is_own(const std::string& address) {
  const auto own = interfaces_that_are_up();
  return address.starts_with("127.") ||
         std::ranges::any_of(own, [&](const Interface& i) { return i.address == address; });
}

// Returns whether the other machine's kernel reports the port as closed; a firewall usually drops the datagram instead.
bool says_that_it_is_closed(const std::string& address, std::uint16_t port) {
  const auto to = socket_address(address, port);
  const Udp udp;
  if (!to || !udp.connect(*to)) return false;
  udp.send();
  return udp.receives_within(patience_with_kernel) && udp.error() == ECONNREFUSED;
}

}  // namespace

std::string holder_of_port(std::uint16_t port) {
  const std::vector<std::string> inodes = sockets_of_port(port);
  if (inodes.empty()) return {};
  std::error_code ignored;
  for (const auto& process : fs::directory_iterator("/proc", ignored)) {
    const std::string pid = process.path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    for (const auto& file : fs::directory_iterator(process.path() / "fd", ignored)) {
      const std::string target = fs::read_symlink(file.path(), ignored);
      if (std::ranges::none_of(inodes, [&](const auto& inode) { return target == "socket:[" + inode + "]"; })) continue;
      std::ifstream in(process.path() / "comm");
      std::string name;
      std::getline(in, name);
      return fmt::format("process {} ({})", pid, name);
    }
  }
  return "another user's process";
}

std::vector<Finding> check_interfaces(const std::string& address) {
  const std::vector<Interface> all = interfaces_that_are_up();
  if (all.empty())
    return {{"interface", Health::problem, "no network interface is up, not even the loopback",
             "As root: ip link set lo up"}};
  std::vector<std::string> texts;
  std::size_t outward = 0;
  for (const Interface& each : all) {
    texts.push_back(fmt::format("{} ({})", each.address, each.name));
    if (!each.is_loopback) ++outward;
  }
  Finding finding{"interface", Health::ok, fmt::format("{}", fmt::join(texts, ", "))};
  if (!is_own(address)) {
    finding.health = Health::problem;
    finding.found =
        fmt::format("no active interface has the address {}; active interfaces: {}", address, finding.found);
    finding.advice = "Use one of these addresses for --network; 'ip address' also lists inactive interfaces.";
  } else if (address.starts_with("127.")) {
    finding.found += "; a server on " + address + " can be reached from this machine only";
    if (outward > 0) finding.found += ", a server on another address from the network of that address";
  } else if (outward > 1) {
    finding.found += fmt::format("; {} is used: clients must be on its network", address);
  }
  return {finding, {"multicast", Health::ok, "not needed: clients connect to the address that they are given"}};
}

Finding check_ports(std::uint32_t domain, const std::string& address, const std::vector<std::uint32_t>& participants) {
  std::map<std::string, std::vector<std::uint16_t>> taken;
  for (const std::uint32_t participant : participants)
    for (std::uint16_t port = wire::discovery_port(domain, participant), last = port + 1; port <= last; ++port)
      if (std::string holder = holder_of_port(port); !holder.empty()) taken[holder].push_back(port);
  const std::uint16_t first = wire::discovery_port(domain, participants.front());
  const std::uint16_t last = wire::discovery_port(domain, participants.back()) + 1;
  Finding finding{"ports", Health::ok, fmt::format("UDP {} to {} of domain {}", first, last, domain)};
  if (taken.empty()) {
    finding.found += " are free";
    if (is_ephemeral(last)) {
      finding.health = Health::warning;
      finding.advice = "The kernel may assign these ports to any program: choose a domain below 100.";
    }
    return finding;
  }
  std::vector<std::string> texts;
  bool is_ours = taken.size() == 1;
  for (const auto& [holder, ports] : taken) {
    texts.push_back(fmt::format("{} by {}", fmt::join(ports, ", "), holder));
    is_ours &= holder.ends_with("(cohort)");
  }
  finding.found += fmt::format(" are taken: {}", fmt::join(texts, "; "));
  if (is_ours) {
    finding.found += ", a server";
  } else {
    finding.health = Health::problem;
    finding.advice = fmt::format(
        "Another program, or a second server, uses the ports of this domain on {}: end it, or choose another --domain "
        "for server and clients.",
        address);
  }
  return finding;
}

Finding check_firewall(std::uint32_t domain, const std::string& address) {
  const std::uint16_t port = wire::discovery_port(domain);
  const auto own = socket_address(address, port);
  const Udp receiver;
  if (!own || !receiver.bind(*own))
    return {"firewall", Health::ok, fmt::format("not tested: UDP port {} of {} is in use", port, address)};
  const Udp sender;
  if (sender.connect(*own) && sender.send() == 0 && receiver.receives_within(patience_with_kernel))
    return {"firewall", Health::ok, fmt::format("a datagram to UDP port {} of {} arrives", port, address)};
  return {"firewall", Health::problem,
          fmt::format("a datagram to UDP port {} of {} is lost on this machine", port, address),
          fmt::format(
              "A firewall drops it: allow UDP ports {} and {} ('nft list ruleset' or 'iptables -L' lists the rules).",
              port, port + 1)};
}

Finding check_server(const DoctorCommand& command, const std::optional<wire::Identity>& identity, bool is_expected) {
  const std::uint16_t port = wire::discovery_port(command.domain(), identity ? identity->participant : 0);
  const std::string where = fmt::format("{}, domain {}", command.server, command.domain());
  const Health bad = is_expected ? Health::problem : Health::ok;
  if (says_that_it_is_closed(command.server, port))
    return {"server", bad, fmt::format("at {}, UDP port {} is closed", where, port),
            is_expected ? "Start the server, or correct --domain; a server for other machines needs --network." : ""};
  const wire::Survey survey = wire::survey(command.domain(), command.server, identity, patience_with_server);
  if (!survey.majors.empty())
    return {"server", Health::problem,
            fmt::format("at {}, a server uses version {} of the protocol; this program uses version 1", where,
                        fmt::join(survey.majors, ", ")),
            "Install the same major version of Cohort on both sides."};
  if (!survey.models.empty()) {
    std::string found = fmt::format("at {}, a server answers; its robots: {}", where, fmt::join(survey.models, ", "));
    if (survey.run)
      found += fmt::format("; run {} is at tick {}", *survey.run, survey.tick);
    else if (!identity || identity->role == wire::Role::observer)
      found += "; no run is in progress: the server may be waiting for controllers";
    return {"server", Health::ok, found};
  }
  if (survey.has_server)
    return {"server", Health::problem, fmt::format("at {}, there is a server, but none of its messages arrive", where),
            "Large messages are lost: look for a firewall that drops fragments, and check the buffers."};
  const std::string holder = is_own(command.server) ? holder_of_port(port) : "";
  if (holder.ends_with("(cohort)") || (!holder.empty() && identity))
    return {"server", Health::problem,
            fmt::format("at {}, {} uses UDP port {}, but refuses the connection", where, holder, port),
            identity ? "The certificates come from different authorities, a certificate has expired, or the server "
                       "runs without --secure."
                     : "The server runs with --secure: use --secure DIR/clients/NAME."};
  return {
      "server", bad, fmt::format("at {}, no server answers on UDP port {}", where, port),
      is_expected
          ? fmt::format("The address is wrong, a firewall drops UDP ports {} and {}, or the server runs {}.", port,
                        port + 1, identity ? "without --secure or with another folder of identities" : "with --secure")
          : ""};
}

}  // namespace cohort::tool
