// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/sitl_command_line.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/bridges/betaflight/sitl_packets.hpp"

namespace cohort::betaflight {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds polled_every{50};
constexpr std::chrono::milliseconds asked_again_after{2'000};

}  // namespace

CommandLine::CommandLine(const bridges::Descriptor& socket, std::chrono::seconds patience, std::function<void()> check)
    : socket_(socket.number()), patience_(patience), check_(std::move(check)) {
  connect();
  enter();
}

// The program listens before it reads, and forgets what came too early.
void CommandLine::enter() {
  const auto until = Clock::now() + patience_;
  // Alone in its packet: what follows at once would be taken for something else.
  send("#");
  bool is_first = true;
  while (!find_prompt(asked_again_after)) {
    if (Clock::now() > until) throw Silent("Betaflight's CLI does not respond to '#'");
    send("#");
    is_first = false;
  }
  // The second '#' begins a comment.
  if (!is_first) execute("");
}

void CommandLine::connect() {
  const sockaddr nowhere{AF_UNSPEC, {}};
  static_cast<void>(::connect(socket_, &nowhere, sizeof nowhere));  // ends an earlier connection
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  endpoint.sin_port = htons(cli_port);
  endpoint.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto until = Clock::now() + patience_;
  while (::connect(socket_, reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0) {
    check_();
    if (Clock::now() > until) throw Silent("the program does not listen on TCP port " + std::to_string(cli_port));
    std::this_thread::sleep_for(polled_every);
  }
}

void CommandLine::execute(const std::string& command) {
  send(command + "\n");
  const std::string reply = read_to_prompt(command);
  if (reply.find("###ERROR") != std::string::npos)
    throw std::runtime_error("Betaflight's CLI rejects '" + command + "': " + reply);
}

void CommandLine::save() { send("save\n"); }

void CommandLine::send(const std::string& text) const {
  if (::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("Betaflight has closed its CLI");
}

std::string CommandLine::read_to_prompt(const std::string& of) {
  const auto reply = find_prompt(patience_);
  if (!reply) throw std::runtime_error("Betaflight's CLI does not respond to '" + of + "'");
  return *reply;
}

std::optional<std::string> CommandLine::find_prompt(std::chrono::milliseconds at_most) {
  constexpr std::size_t most = 65536;
  std::string reply;
  const auto until = Clock::now() + at_most;
  while (!reply.ends_with("\n# ")) {
    check_();
    pollfd waited{socket_, POLLIN, 0};
    std::array<char, 1024> bytes{};
    if (::poll(&waited, 1, static_cast<int>(polled_every.count())) > 0) {
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count <= 0) throw std::runtime_error("Betaflight has closed its CLI");
      reply.append(bytes.data(), static_cast<std::size_t>(count));
    }
    if (reply.size() > most || Clock::now() > until) return std::nullopt;
  }
  return reply;
}

}  // namespace cohort::betaflight
