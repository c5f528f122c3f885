// SPDX-License-Identifier: Apache-2.0
#include "tests/support/http.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <optional>

#include "tests/support/patience.hpp"

namespace cohort::test {
namespace {

// A port that is published for a container accepts before anybody listens in it, and then closes without a word.
std::string asked_once(const std::string& port, const std::string& request) {
  const TcpConnection connection;
  if (!connection.connect(port) || !connection.send(request)) return {};
  std::string answer;
  for (std::string part = connection.receive(); !part.empty(); part = connection.receive()) {
    answer += part;
    if (answer.starts_with("HTTP/1.1 101 ") && answer.find("\r\n\r\n") != std::string::npos) break;
  }
  return answer;
}

}  // namespace

TcpConnection::TcpConnection() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval limit{std::chrono::seconds(patience).count(), 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

TcpConnection::~TcpConnection() { close(socket_); }

bool TcpConnection::connect(const std::string& port) const {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

bool TcpConnection::send(const std::string& text) const {
  return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
}

std::string TcpConnection::receive() const {
  std::array<char, 65536> part{};
  const ssize_t size = recv(socket_, part.data(), part.size(), 0);
  return {part.data(), static_cast<std::size_t>(size > 0 ? size : 0)};
}

std::string http_get(const std::string& port, const std::string& target, const std::string& headers) {
  const std::string connection = headers.find("Connection:") == std::string::npos ? "Connection: close\r\n" : "";
  const std::string request =
      "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + port + "\r\n" + connection + headers + "\r\n";
  std::string answer;
  eventually([&] { return !(answer = asked_once(port, request)).empty(); }, patience, std::chrono::milliseconds(20));
  return answer;
}

std::string http_get_socket(const std::string& port, const std::string& target) {
  return http_get(port, target,
                  "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n");
}

std::string port_in(const std::string& output) {
  const std::string before = "http://127.0.0.1:";
  const std::size_t begin = output.find(before) + before.size();
  return output.substr(begin, output.find('/', begin) - begin);
}

void expect_page(const std::string& port) {
  const std::string page = http_get(port, "/");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 ")) << page;
  EXPECT_NE(page.find("<title>Cohort</title>"), std::string::npos) << page;
  EXPECT_GT(http_get(port, "/page.js").size(), 100'000u);
  EXPECT_GT(http_get(port, "/page.css").size(), 1'000u);
}

std::string free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool is_bound = bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                        getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(socket);
  EXPECT_TRUE(is_bound);
  return std::to_string(ntohs(address.sin_port));
}

}  // namespace cohort::test
