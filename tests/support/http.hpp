// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace cohort::test {

/// A connection to a port of the loopback interface.
class TcpConnection {
 public:
  TcpConnection();
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;
  ~TcpConnection();

  bool connect(const std::string& port) const;
  /// Sends all of the text. Returns false if this fails.
  bool send(const std::string& text) const;
  /// Waits for data and returns them; empty at the end.
  std::string receive() const;

 private:
  int socket_;
};

/// Returns the response of the server at this port of the loopback interface to a GET of `target`, with status line and
/// headers. Reads to the end of the connection or, if the protocol is switched (101), of the headers. Waits until a
/// server listens; returns an empty text if none does. `headers` are additional headers, each with its "\r\n".
std::string http_get(const std::string& port, const std::string& target, const std::string& headers = "");

/// Like http_get, but requests the view's WebSocket. `target` must contain its token.
std::string http_get_socket(const std::string& port, const std::string& target);

/// Returns the port in the address that a view has printed.
std::string port_in(const std::string& output);

/// Checks that a view serves the complete page at this port.
void expect_page(const std::string& port);

/// Returns a port of the loopback interface on which no program listens.
std::string free_port();

}  // namespace cohort::test
