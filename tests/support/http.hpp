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
  /// What has come, once something has; empty at the end.
  std::string receive() const;

 private:
  int socket_;
};

/// What a server at this port of the loopback answers to GET of `target`, status line and headers included, to the end
/// of the connection or, of a connection that becomes another (101), of the headers. Waits until somebody listens;
/// empty if nobody does. `headers`: more of them, each with its "\r\n".
std::string http_get(const std::string& port, const std::string& target, const std::string& headers = "");

/// The same, asking for a WebSocket of the view, which needs its token.
std::string http_get_socket(const std::string& port, const std::string& target);

/// The port in the address that a view has printed.
std::string port_in(const std::string& output);

/// A view serves the page there, all of it.
void expect_page(const std::string& port);

/// A port of the loopback that nobody listens at.
std::string free_port();

}  // namespace cohort::test
