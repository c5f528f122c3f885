// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/participant.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "idl/dds/dds.hpp"
#include "idl/text/printable.hpp"

namespace cohort::wire {
namespace {

// The last domain whose ports exist; those of the next one would exceed 65535.
constexpr std::uint32_t last_domain = 232;
// The last domain for which DDS Security has permissions.
constexpr std::uint32_t last_secure_number = 230;

void print_log(std::string_view message, DdsLogKind kind) noexcept {
  static const bool shown = [] {
    const char* level = std::getenv("COHORT_LOG");
    return level != nullptr && std::string_view(level) == "debug";
  }();
  if (shown || kind != DdsLogKind::detail)
    std::fprintf(stderr, "dds: %s\n", printable(message, std::string::npos, Lines::kept).c_str());
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one log for the process.
std::atomic<DdsLogReceiver> receive_log_now = &print_log;
void receive_log(std::string_view message, DdsLogKind kind) noexcept { receive_log_now.load()(message, kind); }

// Captures the log of Cyclone from calls of this thread. Cyclone has one log per process, and reports the reason of a
// failure only there.
class LogCapture {
 public:
  LogCapture() {
    install_sink();
    current_ = this;
  }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  ~LogCapture() { current_ = nullptr; }

  const std::string& text() const { return text_; }

 private:
  static void install_sink() {
    static const bool installed = [] {
      dds_set_log_sink(&LogCapture::receive, nullptr);
      dds_set_trace_sink(&LogCapture::receive, nullptr);
      return true;
    }();
    static_cast<void>(installed);
  }

  static void receive(void*, const dds_log_data_t* entry) noexcept {
    std::string_view message(entry->message, entry->size);
    if (message.ends_with('\n')) message.remove_suffix(1);
    if (current_ != nullptr) {
      if (!current_->text_.empty()) current_->text_ += "; ";
      current_->text_ += message;
    }
    receive_log(message, (entry->priority & DDS_LC_FATAL) != 0 ? DdsLogKind::fatal : DdsLogKind::detail);
    if (const auto refusal = refusal_told_first(message)) receive_log(*refusal, DdsLogKind::refusal);
  }

  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one sink for the process.
  static inline thread_local LogCapture* current_ = nullptr;
  std::string text_;
};

class UdpSocket {
 public:
  UdpSocket() : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (descriptor_ < 0) throw WireError("cannot open a UDP socket: " + std::generic_category().message(errno));
  }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket() { ::close(descriptor_); }

  /// Binds the socket. Returns 0 or errno.
  int bind(const sockaddr_in& address) const { return call(::bind, address); }
  int connect(const sockaddr_in& address) const { return call(::connect, address); }

  in_addr local_address() const {
    sockaddr_in local{};
    socklen_t size = sizeof(local);
    ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&local), &size);
    return local.sin_addr;
  }

 private:
  int call(int (*function)(int, const sockaddr*, socklen_t), const sockaddr_in& address) const {
    return function(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ? 0 : errno;
  }

  int descriptor_;
};

sockaddr_in socket_address(in_addr address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr = address;
  result.sin_port = htons(port);
  return result;
}

in_addr resolve(const std::string& name) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(name.c_str(), nullptr, &hints, &found); error != 0) {
    throw WireError("cannot find the address of '" + name + "': " + ::gai_strerror(error) +
                    ". Give an IPv4 address, or a host name that has one.");
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, ::freeaddrinfo);
  return reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr;
}

std::string to_text(in_addr address) {
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &address, text, sizeof(text));
  return text;
}

bool is_loopback(in_addr address) { return (ntohl(address.s_addr) >> 24) == 127; }

bool is_taken(std::uint16_t port) { return UdpSocket().bind(socket_address(in_addr{INADDR_ANY}, port)) == EADDRINUSE; }

// Returns the IPv4 addresses of the network interfaces that are up.
std::vector<in_addr> addresses_in_use() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, ::freeifaddrs);
  std::vector<in_addr> addresses;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next)
    if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET && (entry->ifa_flags & IFF_UP) != 0)
      addresses.push_back(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr);
  return addresses;
}

// Checks the address here, because Cyclone's error contains neither the address nor the existing ones.
void expect_own(in_addr wanted) {
  std::string others;
  for (const in_addr address : addresses_in_use()) {
    // All addresses of 127.0.0.0/8 are loopback.
    if (address.s_addr == wanted.s_addr || (is_loopback(address) && is_loopback(wanted))) return;
    others += (others.empty() ? "" : ", ") + to_text(address);
  }
  if (others.empty()) throw WireError("this machine has no network interface that is up, not even loopback");
  throw WireError("no active network interface has the address " + to_text(wanted) + "; known: " + others);
}

in_addr own_address_towards(in_addr server, std::uint16_t port) {
  const UdpSocket socket;
  if (const int error = socket.connect(socket_address(server, port)); error != 0) {
    throw WireError("no route to the server at " + to_text(server) + ": " + std::generic_category().message(error));
  }
  return socket.local_address();
}

std::string configuration(std::uint32_t domain, in_addr own_address, const std::string& discovery) {
  std::string xml = R"(<CycloneDDS><Domain Id="any"><General><AllowMulticast>false</AllowMulticast>)";
  xml += R"(<Interfaces><NetworkInterface address=")" + to_text(own_address) + R"("/></Interfaces>)";
  // Use large datagrams on the loopback only. On a network, each datagram fits into one packet. If a
  // datagram loses a part, the kernel keeps the rest for 30 s; once it has kept too many, it accepts no further ones.
  xml += is_loopback(own_address) ? "<MaxMessageSize>65500B</MaxMessageSize><FragmentSize>60000B</FragmentSize>"
                                  : "<MaxMessageSize>1472B</MaxMessageSize><FragmentSize>1344B</FragmentSize>";
  xml += "</General><Discovery><LeaseDuration>5s</LeaseDuration>" + discovery;
  xml += "<ExternalDomainId>" + std::to_string(domain) + "</ExternalDomainId></Discovery><Internal>";
  // Below the watermark, a write never waits for acknowledgements, which arrive on the thread that may be writing.
  xml += "<Watermarks><WhcHigh>16MB</WhcHigh><WhcHighInit>16MB</WhcHighInit></Watermarks>";
  // No minimum, which would be an error if the kernel allows less.
  xml += R"(<SocketReceiveBufferSize max="4MB"/>)";
  // Time that a writer waits for possibly dead readers when it is destroyed.
  xml += "<WriterLingerDuration>100ms</WriterLingerDuration></Internal></Domain></CycloneDDS>";
  return xml;
}

// Creates a participant. Cyclone allows one participant configuration for each domain number in a process. Further
// participants of the same domain use another number internally; on the network, the domain is that of the
// configuration. Returns null if DDS fails; its log has the reason.
std::unique_ptr<ParticipantState> try_to_join(std::uint32_t domain, const std::string& configuration,
                                              const dds_qos_t* qos, bool is_secure) {
  std::uint32_t number = domain;
  dds_entity_t handle = dds_create_domain(number, configuration.c_str());
  while (handle == DDS_RETCODE_PRECONDITION_NOT_MET) {
    // DDS Security supports no numbers above those that a domain can have on the network.
    number = is_secure ? (number + 1) % (last_secure_number + 1) : number + last_domain + 1;
    if (number == domain) throw WireError("too many DDS participants in this process");
    handle = dds_create_domain(number, configuration.c_str());
  }
  if (handle < 0) return nullptr;
  auto state = std::make_unique<ParticipantState>();
  state->domain = Entity(handle);
  handle = dds_create_participant(number, qos, nullptr);
  if (handle < 0) return nullptr;
  state->participant = Entity(handle);
  return state;
}

// Joins a domain. Returns null also if DDS does not accept the identity.
std::unique_ptr<ParticipantState> join(std::uint32_t domain, const std::string& configuration,
                                       const std::optional<Identity>& identity) {
  const Qos qos = make_qos();
  if (identity) secure(qos.get(), *identity);
  auto state = try_to_join(domain, configuration, qos.get(), identity.has_value());
  if (state != nullptr) state->identity = identity;
  return state;
}

std::string peer(in_addr address, std::uint16_t port) {
  return "<Peer address=\"" + to_text(address) + ":" + std::to_string(port) + "\"/>";
}

std::string as_whom(const std::optional<Identity>& identity) {
  return identity ? " with the identity in " + identity->folder.string() : std::string();
}

}  // namespace

void set_dds_log(DdsLogReceiver receiver) { receive_log_now = receiver == nullptr ? &print_log : receiver; }

std::unique_ptr<ParticipantState> join_domain(std::uint32_t domain, const std::string& configuration,
                                              const dds_qos_t* qos) {
  LogCapture log;
  auto state = try_to_join(domain, configuration, qos, false);
  if (state == nullptr) throw WireError("cannot join domain " + std::to_string(domain) + ": " + log.text());
  return state;
}

dds_return_t check(dds_return_t result, const char* verb, const char* object) {
  if (result >= 0) return result;
  throw WireError(std::string("DDS cannot ") + verb + " " + object + ": " + dds_strretcode(-result));
}

std::string partition_of(std::uint64_t client) {
  char text[18] = {};
  std::snprintf(text, sizeof(text), "c%016llx", static_cast<unsigned long long>(client));
  return text;
}

std::uint16_t discovery_port(std::uint32_t domain, std::uint32_t participant) {
  if (domain > last_domain) {
    throw WireError("domain " + std::to_string(domain) + " is out of range; expected 0 to " +
                    std::to_string(last_domain) + ", preferably below 100");
  }
  return static_cast<std::uint16_t>(7410 + 250 * domain + 2 * participant);
}

Participant Participant::server(std::uint32_t domain, const std::string& address,
                                const std::optional<Identity>& identity) {
  const std::uint32_t index = identity ? identity->participant : 0;
  const std::uint16_t port = discovery_port(domain, index);
  const in_addr own_address = resolve(address);
  expect_own(own_address);
  std::string discovery =
      "<ParticipantIndex>" + std::to_string(index) + "</ParticipantIndex><SPDPInterval>5s</SPDPInterval>";
  // Without a peer, Cyclone announces itself to the first ports of this machine, where other participants of the server
  // would refuse it repeatedly. So its peer is itself.
  if (identity) discovery += "<Peers>" + peer(own_address, port) + "</Peers>";
  LogCapture log;
  auto state = join(domain, configuration(domain, own_address, discovery), identity);
  if (state == nullptr) {
    const auto data_port = static_cast<std::uint16_t>(port + 1);
    if (is_taken(port) || is_taken(data_port)) {
      throw DomainTaken(
          "domain " + std::to_string(domain) + " is in use: another program uses UDP port " + std::to_string(port) +
          " or " + std::to_string(data_port) +
          ", most likely another server. Stop it, or choose another domain for this server and its clients.");
    }
    throw WireError("cannot serve domain " + std::to_string(domain) + " at " + address + as_whom(identity) + ": " +
                    log.text());
  }
  return Participant(std::move(state));
}

Participant Participant::client(std::uint32_t domain, const std::string& address,
                                const std::optional<Identity>& identity) {
  if (identity && identity->role == Role::server)
    throw WireError(identity->folder.string() + " is the server's identity; use a client's folder in clients/");
  const std::uint16_t port = discovery_port(domain, identity ? identity->participant : 0);
  const in_addr server = resolve(address);
  // A client announces itself every second, only to the server. So it finds a server that starts later within a second,
  // at the cost of one small packet per second. The server need not repeat its announcement, because it answers each
  // one.
  const std::string discovery =
      "<ParticipantIndex>none</ParticipantIndex><SPDPInterval>1s</SPDPInterval>"
      "<Peers>" +
      peer(server, port) + "</Peers>";
  LogCapture log;
  auto state = join(domain, configuration(domain, own_address_towards(server, port), discovery), identity);
  if (state == nullptr) {
    throw WireError("cannot join domain " + std::to_string(domain) + " of the server at " + address +
                    as_whom(identity) + ": " + log.text());
  }
  return Participant(std::move(state));
}

Participant::Participant(std::unique_ptr<ParticipantState> state) : state_(std::move(state)) {}
Participant::Participant(Participant&&) noexcept = default;
Participant& Participant::operator=(Participant&&) noexcept = default;
Participant::~Participant() = default;

const std::optional<Identity>& Participant::identity() const { return state_->identity; }

}  // namespace cohort::wire
