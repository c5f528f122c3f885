// SPDX-License-Identifier: Apache-2.0

// A small bridge: firmware with a UDP interface drives one robot of a simulation in lockstep.
//
//   udp_bridge ROBOT PORT       the server's domain is $COHORT_DOMAIN, its address $COHORT_SERVER
//
// At each tick, the bridge sends one text datagram to 127.0.0.1:PORT, `TICK VALUE VALUE ...`, with the robot's whole
// observation. It waits for a datagram with the robot's whole command, `TICK VALUE VALUE ...`. The values are in the
// order of the robot's channels, which the bridge prints. It sends a lost datagram again after a second.

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cohort/client.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace {

// A UDP socket connected to the firmware.
class FirmwarePort {
 public:
  explicit FirmwarePort(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in firmware{};
    firmware.sin_family = AF_INET;
    firmware.sin_port = htons(port);
    firmware.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&firmware), sizeof firmware) != 0)
      throw std::runtime_error("cannot open port " + std::to_string(port));
  }
  FirmwarePort(const FirmwarePort&) = delete;
  FirmwarePort& operator=(const FirmwarePort&) = delete;
  ~FirmwarePort() { ::close(socket_); }

  // Sends a datagram; errors are ignored, because lost datagrams are sent again.
  void send(const std::string& text) const { static_cast<void>(!::send(socket_, text.data(), text.size(), 0)); }

  std::optional<std::string> receive(int milliseconds) const {
    pollfd readable{socket_, POLLIN, 0};
    if (::poll(&readable, 1, milliseconds) != 1) return std::nullopt;
    std::string text(65536, ' ');
    const ssize_t size = ::recv(socket_, text.data(), text.size(), 0);
    if (size < 0) return std::nullopt;  // the firmware is not running yet
    text.resize(static_cast<std::size_t>(size));
    return text;
  }

 private:
  int socket_;
};

void print_channels(const cohort::DrivenRobot& robot) {
  std::printf("%s observes", robot.start.name.c_str());
  for (const cohort::ChannelInfo& channel : robot.start.observation_channels)
    std::printf(" %s[%u]", channel.name.c_str(), channel.size);
  std::printf(" and is commanded by");
  for (const cohort::ChannelInfo& channel : robot.start.command_channels)
    std::printf(" %s[%u]", channel.name.c_str(), channel.size);
  std::printf(", each %u ticks\n", robot.policy.period);
}

std::string text_of(std::uint64_t tick, const cohort::FrameRobot& robot) {
  std::ostringstream text;
  text << tick << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (const cohort::ChannelInfo& channel : robot.robot->start.observation_channels)
    for (const double value : robot.observation.values({channel.offset, channel.size})) text << ' ' << value;
  return text.str();
}

// Sets the command from the firmware's answer. Returns false if the answer is for another tick.
bool set_command(const std::string& answer, std::uint64_t tick, cohort::FrameRobot& robot) {
  std::istringstream text(answer);
  std::uint64_t answered = 0;
  if (!(text >> answered) || answered != tick) return false;
  for (const cohort::ChannelInfo& channel : robot.robot->start.command_channels)
    for (std::uint32_t i = 0; i < channel.size; ++i) {
      double value = 0.0;
      if (!(text >> value)) throw std::runtime_error("the firmware's answer lacks a value for " + channel.name);
      robot.command.set({channel.offset, channel.size, channel.lower, channel.upper}, value, i);
    }
  return true;
}

// Exchanges an observation and a command with the firmware. Returns false if the run ends before the answer.
bool exchange(const FirmwarePort& firmware, std::uint64_t tick, cohort::FrameRobot& robot,
              const cohort::Client& client) {
  while (!client.is_over()) {
    firmware.send(text_of(tick, robot));
    while (const auto answer = firmware.receive(1000))
      if (set_command(*answer, tick, robot)) return true;
  }
  return false;
}

int run(const std::string& robot, std::uint16_t port) {
  const FirmwarePort firmware(port);
  cohort::ClientOptions options;
  options.robots = {robot};
  options.name = "udp_bridge";
  cohort::take_environment(options);
  cohort::Client client(options);
  for (;;) {
    const cohort::ClientEvent event = client.next();
    if (const auto* lease = std::get_if<cohort::LeaseStart>(&event)) print_channels(lease->robots[0]);
    if (const auto* save = std::get_if<cohort::SaveState>(&event)) save->state->leave_out();
    if (const auto* ended = std::get_if<cohort::ClientEnded>(&event)) return cohort::exit_code_of(ended->end);
    if (const auto* frame = std::get_if<cohort::Frame>(&event)) {
      try {
        if (exchange(firmware, frame->tick, frame->robots[0], client)) client.answer();
      } catch (const std::exception& error) {
        client.fail(error.what());
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "Usage: %s ROBOT PORT\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1], static_cast<std::uint16_t>(std::stoul(argv[2])));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "udp_bridge: %s\n", error.what());
    return 2;
  }
}
