// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <thread>

#include "idl/dds/transport.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

// The ticks of a run, as an observer receives them.
class Ticks {
 public:
  explicit Ticks(std::uint32_t domain)
      : participant_(wire::Participant::client(domain)),
        reader_(participant_, {[this](const wire::WorldState& state, const wire::Sender&) { tick_ = state.tick; }, {}},
                "view") {}
  bool have_begun() const {
    return eventually([&] { return tick_ > 0; });
  }
  double per_second(std::chrono::milliseconds time) const {
    const std::uint64_t before = tick_;
    const auto start = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(time);
    return static_cast<double>(tick_ - before) /
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  std::atomic<std::uint64_t> tick_ = 0;
  wire::Participant participant_;
  wire::Reader<wire::WorldState> reader_;
};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// Sends a hundred thousand messages a second, alternately to the server and to an idle one. So the load of the flooder
// itself, more than a core, is the same in both cases.
TEST(FloodsNeverStopARun, OfCommandsLeaveOthersOneThirdOfTheirPace) {
  const FieldOfRobots field(64, 1e6);
  const ReservedDomain domain, elsewhere;
  Process server(field.serve(domain));
  Process idle({cohort_program(), "serve", field.file(), "--domain", elsewhere.text()});
  Process controllers(FieldOfRobots::host(domain, "all"));
  const Ticks ticks(domain.number());
  ASSERT_TRUE(ticks.have_begun()) << server.output();
  Process flood({COHORT_BUILD_DIR "/bin/flood", domain.text(), elsewhere.text(), "100000"});
  std::vector<double> here, there;
  for (int round = 0; round < 10; ++round) {
    ASSERT_TRUE(flood.wait_for_output("turn " + std::to_string(round) + ".")) << flood.output();
    (round % 2 == 0 ? here : there).push_back(ticks.per_second(400ms));
    flood.signal(SIGUSR1);
  }
  flood.signal(SIGKILL);
  flood.wait_for_exit();
  const double quiet = ticks.per_second(400ms);
  RecordProperty("ticks_per_second", std::to_string(median(here)) + " flooded, " + std::to_string(median(there)) +
                                         " beside a flood, " + std::to_string(quiet) + " without");
  EXPECT_GT(std::ranges::min(here), 0.0) << "it never stops";
  // More than half if a core is free to read them; on a busy machine they cost the server its share of the time.
  EXPECT_GT(median(here), median(there) / 3) << median(here) << " ticks/s of " << median(there);
  server.signal(SIGINT);
  EXPECT_EQ(server.wait_for_exit(), 130) << server.output();
  EXPECT_GT(events_of(field.summary(), "rejected").size(), 0u) << "it is named";
}

// Packets that are not DDS at all, and RTPS packets with changed bytes.
TEST(FloodsNeverStopARun, OfMalformedPackets) {
  const FieldOfRobots field(4, 20.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--speed", "10"}));
  Process controllers(FieldOfRobots::host(domain, "all"));
  ASSERT_TRUE(server.wait_for_output("simulated")) << server.output();
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::mt19937 random(7);
  const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
  // The header of RTPS 2.1 and some submessages: INFO_TS, DATA, HEARTBEAT, ACKNACK, DATA_FRAG.
  const std::string header("RTPS\2\1\1\20abcdefghijkl", 20);
  const std::string submessages[] = {
      std::string("\x09\x01\x08\x00\0\0\0\0\0\0\0\0", 12),
      std::string(
          "\x15\x05\x2c\x00\0\0\x10\0\0\0\0\0\0\x01\0\xc2\0\0\0\0\x01\0\0\0\0\x03\0\0\x50\0\x10\0abcdefghijklmnop", 48),
      std::string("\x07\x01\x1c\x00\0\0\0\0\0\x01\0\xc2\0\0\0\0\x01\0\0\0\0\0\0\0\x05\0\0\0\x01\0\0\0", 32),
      std::string("\x06\x03\x18\x00\0\0\0\0\0\x01\0\xc2\0\0\0\0\x01\0\0\0\x20\0\0\0\xff\xff\xff\xff", 28),
      std::string("\x16\x01\x2c\x00\0\0\x1c\0\0\0\0\0\0\x01\0\xc2\0\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\xff\xff\xff\xff\x7f"
                  "\0abcdefghij",
                  46)};
  for (int i = 0; i < 20000; ++i) {
    std::string packet;
    if (below(4) == 0) {
      packet.resize(below(1400));
      for (char& byte : packet) byte = static_cast<char>(below(256));
    } else {
      packet = header;
      for (std::size_t part = below(6); part > 0; --part) packet += submessages[below(std::size(submessages))];
      for (std::size_t change = below(8); change > 0; --change)
        packet[below(packet.size())] = static_cast<char>(below(256));
      packet.resize(packet.size() - below(std::min<std::size_t>(packet.size(), 12)));
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(wire::discovery_port(domain.number()) + below(2)));
    sendto(sender, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    if (i % 100 == 0) std::this_thread::sleep_for(1ms);
  }
  close(sender);
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  EXPECT_EQ(field.summary()["state_hash"], expected);
}

// A stopped client reads nothing. Its robots hold their commands, the server keeps its pace, and no memory accumulates.
TEST(FloodsNeverStopARun, OfFramesToAClientThatNeverReads) {
  const FieldOfRobots field(16, 1e4, ", on_late: hold, deadline: 0.005");
  const ReservedDomain domain;
  Process server(field.serve(domain));
  Process reads(FieldOfRobots::host(domain, "0..7"));
  Process never_reads(FieldOfRobots::host(domain, "8..15"));
  const Ticks ticks(domain.number());
  ASSERT_TRUE(ticks.have_begun()) << server.output();
  never_reads.signal(SIGSTOP);
  const double rate = ticks.per_second(1000ms);
  EXPECT_GT(rate, 50.0) << "each tick waits 5 ms for the one that is stopped, and no longer";
  server.signal(SIGINT);
  EXPECT_EQ(server.wait_for_exit(), 130) << server.output();
  never_reads.signal(SIGCONT);
  EXPECT_GT(field.summary()["misses"].size(), 8u * 50u);
}

}  // namespace
}  // namespace cohort::test
