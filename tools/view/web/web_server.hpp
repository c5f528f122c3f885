// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/view/messages/topics.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// A file of the page, as it is served.
struct PageFile {
  std::string type;  ///< such as `text/html`
  std::string content;
};
/// All files that are served, by the path of the request, such as `/page.js`.
using PageFiles = std::map<std::string, PageFile>;

/// Reads the built page from a folder; returns nothing if it was not built.
PageFiles read_page(const std::filesystem::path& folder);

struct WebOptions {
  std::string name;                    ///< name of the source, shown by other viewers such as Foxglove
  std::string address = "127.0.0.1";   ///< address of the interface
  std::uint16_t port = 8080;           ///< 0: any free one
  std::string token{};                 ///< token that a client must send; empty: none
  std::vector<std::string> origins{};  ///< origins of other pages that may connect, such as `https://app.foxglove.dev`
  bool or_any_free_port = false;       ///< if `port` is in use
  /// Pages that may embed this one in a frame, in the syntax of a content security policy.
  std::string frame_ancestors = "'none'";
};

/// Serves the page and, at `/`, the WebSocket, on one thread. A slow client delays only its own connection, and its
/// waiting messages are limited (ClientSession).
class WebServer {
 public:
  /// Starts to listen. `topics` must outlive this. Throws std::runtime_error if the address or the port cannot be used.
  WebServer(WebOptions options, PageFiles page, Topics& topics);
  ~WebServer();

  std::uint16_t port() const;
  /// Wakes the server to send new messages to clients. Any thread.
  void published();
  /// Runs until `stop` is called. Passes clients' requests to `source`.
  void run(Source& source);
  /// Ends `run`. Any thread.
  void stop();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::view
