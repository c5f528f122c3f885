#pragma once

#include <string>

namespace cohort::test {

/// To a port of the loopback.
class TcpConnection {
 public:
  TcpConnection();
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;
  ~TcpConnection();

  bool connect(const std::string& port) const;
  /// All of it; false if it cannot.
  bool send(const std::string& text) const;
  /// Waits for data and returns them; empty at the end.
  std::string receive() const;

 private:
  int socket_;
};

/// Returns the answer of a server at this port of the loopback to GET of `target`, with status line and headers. It
/// reads to the end of the connection or, if the protocol is switched (101), of the headers. Waits until a server
/// listens; empty if none does. `headers`: additional ones, each with its "\r\n".
std::string http_get(const std::string& port, const std::string& target, const std::string& headers = "");

/// The same, asking for a WebSocket of the view, which needs its token.
std::string http_get_socket(const std::string& port, const std::string& target);

/// The port in the address that a view has printed.
std::string port_in(const std::string& output);

/// A view serves the page there, all of it.
void expect_page(const std::string& port);

/// Returns a port of the loopback on which no program listens.
std::string free_port();

}  // namespace cohort::test
