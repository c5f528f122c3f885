// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>

namespace cohort::tool {

/// A reader of single keys from standard input, which need not be a terminal. During its lifetime, a terminal is in a
/// mode without echo and line buffering. Ctrl-C keeps its meaning.
class KeyReader {
 public:
  KeyReader();
  KeyReader(const KeyReader&) = delete;
  KeyReader& operator=(const KeyReader&) = delete;
  ~KeyReader();

  /// Returns the next key: a character, "space", or "up", "down", "left", "right". Returns nothing if no key arrives in
  /// time. Skips other special keys.
  std::optional<std::string> read(std::chrono::milliseconds at_most);

 private:
  bool wait_for_input(std::chrono::milliseconds at_most) const;

  std::optional<termios> mode_before_;
  bool at_end_ = false;
};

}  // namespace cohort::tool
