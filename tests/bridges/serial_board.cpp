// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/serial_board.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace cohort::test {

SerialBoard::SerialBoard(std::filesystem::path device, Turn turn) : device_(std::move(device)), turn_(std::move(turn)) {
  plug_in();
}

void SerialBoard::plug_in() {
  line_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[128];
  const bool is_made = ::grantpt(line_) == 0 && ::unlockpt(line_) == 0 && ::ptsname_r(line_, name, sizeof name) == 0;
  const int other_end = is_made ? ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC) : -1;
  if (other_end < 0) throw std::runtime_error("no pseudo-terminal");
  // Bytes that the board sends before its line is opened must not come back as an echo.
  termios settings{};
  ::tcgetattr(other_end, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(other_end, TCSANOW, &settings);
  ::close(other_end);
  std::filesystem::create_symlink(name, device_);
  stop_ = false;
  thread_ = std::thread([this, line = line_] { run(line); });
}

void SerialBoard::unplug() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
  std::filesystem::remove(device_);
  ::close(line_);
}

void SerialBoard::run(int line) {
  constexpr int turn_takes = 3;  // [ms]
  while (!stop_) {
    ::poll(nullptr, 0, turn_takes);
    Bytes received;
    std::uint8_t bytes[4096];
    for (ssize_t count = 0; (count = ::read(line, bytes, sizeof bytes)) > 0;)
      received.insert(received.end(), bytes, bytes + count);
    const Bytes sent = turn_(received);
    if (::write(line, sent.data(), sent.size()) < 0) continue;  // no program reads it
  }
}

}  // namespace cohort::test
