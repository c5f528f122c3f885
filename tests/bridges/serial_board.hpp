// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace cohort::test {

/// A board on a serial line that runs on its own clock. A pseudo-terminal takes the place of the line. A name for it
/// appears and disappears with the board, like one of udev.
class SerialBoard {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// Called with what came since the last call, some hundred times a second. Returns what the board sends.
  using Turn = std::function<Bytes(const Bytes& received)>;

  SerialBoard(std::filesystem::path device, Turn turn);
  SerialBoard(const SerialBoard&) = delete;
  SerialBoard& operator=(const SerialBoard&) = delete;
  ~SerialBoard() { unplug(); }

  void unplug();
  void plug_in();

 private:
  void run(int line);

  std::filesystem::path device_;
  Turn turn_;
  int line_ = -1;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace cohort::test
