// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <random>

#include "idl/dds/transport.hpp"
#include "tests/support/control.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

template <class Number>
void append(std::string& to, Number number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void append_parameter(std::string& to, std::uint16_t id, const std::string& value) {
  append(to, id);
  append(to, static_cast<std::uint16_t>(value.size()));
  to += value;
}

// Returns the announcement of a participant that does not exist (SPDP: OMG DDSI-RTPS 2.5, 8.5.3 and 9.6.2.2). It has
// readers and writers for discovery, an unused address, and a lease of an hour.
std::string announcement(std::uint32_t domain, std::mt19937& random) {
  constexpr std::uint16_t discard_port = 9;
  constexpr std::int32_t udp_v4 = 1, seconds_of_lease = 3600;
  constexpr std::uint32_t all_builtin_endpoints = 0xc3f;
  const std::string vendor = "\x01\x10";
  std::string prefix = vendor;
  while (prefix.size() < 12) prefix += static_cast<char>(random() & 0xffU);

  std::string locator, lease, domain_id, endpoints;
  append(locator, udp_v4);
  append(locator, std::uint32_t{discard_port});
  locator += std::string(12, '\0') + std::string("\x7f\0\0\1", 4);
  append(lease, seconds_of_lease);
  append(lease, std::uint32_t{0});
  append(domain_id, domain);
  append(endpoints, all_builtin_endpoints);

  std::string data("\0\0\x10\0\0\1\0\xc7\0\1\0\xc2\0\0\0\0\1\0\0\0\0\3\0\0", 24);
  append_parameter(data, 0x15, std::string("\2\1\0\0", 4));             // protocol version
  append_parameter(data, 0x16, vendor + std::string(2, '\0'));          // vendor
  append_parameter(data, 0x50, prefix + std::string("\0\0\1\xc1", 4));  // GUID
  append_parameter(data, 0x58, endpoints);
  append_parameter(data, 0x32, locator);  // for discovery
  append_parameter(data, 0x31, locator);  // for data
  append_parameter(data, 0x02, lease);
  append_parameter(data, 0x0f, domain_id);
  append_parameter(data, 0x01, "");  // the end

  std::string packet = std::string("RTPS\2\1", 6) + vendor + prefix + std::string("\x15\5", 2);
  append(packet, static_cast<std::uint16_t>(data.size()));
  return packet + data;
}

std::size_t memory_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return 1024 * std::stoul(line.substr(6));
  return 0;
}

// DDS keeps each until its lease ends. They have no other effect on the run or its clients.
TEST(FloodsNeverStopARun, OfForgedAnnouncementsOfParticipants) {
  constexpr int count = 5'000;
  constexpr std::size_t most_bytes_each = 4'000;
  const FieldOfRobots field(4, 5.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused"}));
  Process early(FieldOfRobots::host(domain, "0..1"));
  ASSERT_TRUE(comes_to_drive(domain, 0)) << server.output();
  const std::size_t before = memory_of(server.pid());

  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(wire::discovery_port(domain.number())));
  std::mt19937 random(11);
  for (int i = 0; i < count; ++i) {
    const std::string packet = announcement(domain.number(), random);
    sendto(sender, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    if (i % 50 == 0) std::this_thread::sleep_for(1ms);  // the socket's buffer drops a faster flood
  }
  close(sender);

  Process late(FieldOfRobots::host(domain, "2..3"));
  ASSERT_TRUE(comes_to_drive(domain, 2)) << "newcomers find their way: " << server.output();
  const std::size_t after = memory_of(server.pid());
  EXPECT_GT(after, before + 100 * count) << "they were taken for participants";
  EXPECT_LT(after, before + most_bytes_each * count);
  RecordProperty("bytes_each", std::to_string((after - before) / count));
  control(domain, {"resume"});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(early.wait_for_exit(), 0) << early.output();
  EXPECT_EQ(late.wait_for_exit(), 0) << late.output();
  EXPECT_EQ(field.summary()["state_hash"], expected);
}

}  // namespace
}  // namespace cohort::test
