// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/common/processes/connected_program.hpp"

namespace cohort::film {

/// A client of the Chrome DevTools Protocol (https://chromedevtools.github.io/devtools-protocol) over the pipe of
/// `--remote-debugging-pipe`: JSON messages, each terminated by a NUL. It supports only what films need: one call at a
/// time, in one page.
class DevTools {
 public:
  using Json = nlohmann::json;

  /// `browser` must outlive this.
  explicit DevTools(tool::ConnectedProgram& browser) : browser_(browser) {}

  /// Calls a method and returns its result. Throws std::runtime_error if the browser refuses it, does not respond, or
  /// ends, or if the page crashes.
  Json call(const std::string& method, const Json& parameters = Json::object());
  /// Opens a page of this size [pixels], to which further calls refer.
  void open_page(const std::string& address, std::uint32_t width, std::uint32_t height);
  /// Returns the value of a JavaScript expression, and waits for it if it is a promise. Throws std::runtime_error with
  /// the message of a JavaScript exception.
  Json evaluate(const std::string& expression);

 private:
  tool::ConnectedProgram& browser_;
  std::string session_;
  std::int64_t calls_ = 0;
};

}  // namespace cohort::film
