#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>

namespace cohort::tool {

/// Reads single keys from standard input, which need not be a terminal. A terminal is put into a mode without echo and
/// without lines for as long as this lives. Ctrl-C keeps its meaning.
class KeyReader {
 public:
  KeyReader();
  KeyReader(const KeyReader&) = delete;
  KeyReader& operator=(const KeyReader&) = delete;
  ~KeyReader();

  /// The next key: a character, "space", or "up", "down", "left", "right". Nothing if none comes in time; any other
  /// special key is passed over.
  std::optional<std::string> read(std::chrono::milliseconds at_most);

 private:
  bool wait_for_input(std::chrono::milliseconds at_most) const;

  std::optional<termios> mode_before_;
  bool at_end_ = false;
};

}  // namespace cohort::tool
