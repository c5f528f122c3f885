// A small bridge: firmware that speaks UDP drives one robot of a simulation in lockstep.
//
//   udp_bridge ROBOT PORT       the server's domain is $COHORT_DOMAIN, its address $COHORT_SERVER
//
// Each tick, the bridge sends one datagram of text to 127.0.0.1:PORT, `TICK VALUE VALUE ...` with all that the robot
// observes, and waits for one back, `TICK VALUE VALUE ...` with the robot's whole command. The order of the values is
// that of the robot's channels, which the bridge prints. A datagram that is lost is sent again after a second.

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

// A UDP socket that is connected to the firmware.
class FirmwarePort {
 public:
  explicit FirmwarePort(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in firmware{};
    firmware.sin_family = AF_INET;
    firmware.sin_port = htons(port);
    firmware.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&firmware), sizeof firmware) != 0)
      throw std::runtime_error("cannot reach port " + std::to_string(port));
  }
  FirmwarePort(const FirmwarePort&) = delete;
  FirmwarePort& operator=(const FirmwarePort&) = delete;
  ~FirmwarePort() { ::close(socket_); }

  // What is lost is sent again.
  void send(const std::string& text) const { static_cast<void>(!::send(socket_, text.data(), text.size(), 0)); }

  std::optional<std::string> receive(int milliseconds) const {
    pollfd readable{socket_, POLLIN, 0};
    if (::poll(&readable, 1, milliseconds) != 1) return std::nullopt;
    std::string text(65536, ' ');
    const ssize_t size = ::recv(socket_, text.data(), text.size(), 0);
    if (size < 0) return std::nullopt;  // nobody is there yet
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

// Sets the command from the firmware's answer. False if it answers another tick.
bool set_command(const std::string& answer, std::uint64_t tick, cohort::FrameRobot& robot) {
  std::istringstream text(answer);
  std::uint64_t answered = 0;
  if (!(text >> answered) || answered != tick) return false;
  for (const cohort::ChannelInfo& channel : robot.robot->start.command_channels)
    for (std::uint32_t i = 0; i < channel.size; ++i) {
      double value = 0.0;
      if (!(text >> value)) throw std::runtime_error("the firmware's answer has no value for " + channel.name);
      robot.command.set({channel.offset, channel.size, channel.lower, channel.upper}, value, i);
    }
  return true;
}

// One exchange with the firmware. False if the run is over before it has answered.
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
