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
/// By the path of the request, such as `/page.js`. There is nothing else to get.
using PageFiles = std::map<std::string, PageFile>;

/// The built page in a folder; empty if it was not built.
PageFiles read_page(const std::filesystem::path& folder);

struct WebOptions {
  std::string name;                    ///< name of the source, for other viewers
  std::string address = "127.0.0.1";   ///< address of the interface
  std::uint16_t port = 8080;           ///< 0: any free one
  std::string token{};                 ///< that a client has to give; empty: none
  std::vector<std::string> origins{};  ///< origins of other pages that may connect, such as `https://app.foxglove.dev`
  bool or_any_free_port = false;       ///< where `port` is taken
  /// Pages that may show this one in a frame, as a content security policy names them.
  std::string frame_ancestors = "'none'";
};

/// Serves the page and, at `/`, the WebSocket. One thread runs it; nothing that a browser does takes longer than its
/// own connection, or more memory than one message for each topic.
class WebServer {
 public:
  /// Listens. Throws std::runtime_error if the address or the port cannot be had. All must outlive this.
  WebServer(WebOptions options, PageFiles page, Topics& topics);
  ~WebServer();

  std::uint16_t port() const;
  /// Tells clients that there is something new. Any thread.
  void published();
  /// Runs until `stop`. Passes requests of clients to `source`.
  void run(Source& source);
  /// Any thread.
  void stop();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::view
