// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/terminal/key_reader.hpp"

#include <poll.h>
#include <unistd.h>

#include <thread>

namespace cohort::tool {
namespace {

constexpr char escape = '\033';
constexpr std::chrono::milliseconds rest_of_a_sequence{20};

std::optional<std::string> arrow(char final_character) {
  switch (final_character) {
    case 'A': return "up";
    case 'B': return "down";
    case 'C': return "right";
    case 'D': return "left";
    default: return std::nullopt;
  }
}

bool ends_a_sequence(char character) { return character >= '@' && character <= '~' && character != '['; }

}  // namespace

KeyReader::KeyReader() {
  termios mode{};
  if (tcgetattr(STDIN_FILENO, &mode) != 0) return;  // not a terminal
  mode_before_ = mode;
  mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &mode);
}

KeyReader::~KeyReader() {
  if (mode_before_) tcsetattr(STDIN_FILENO, TCSANOW, &*mode_before_);
}

bool KeyReader::wait_for_input(std::chrono::milliseconds at_most) const {
  if (at_end_) {
    std::this_thread::sleep_for(at_most);
    return false;
  }
  pollfd polled{STDIN_FILENO, POLLIN, 0};
  return poll(&polled, 1, static_cast<int>(at_most.count())) > 0;
}

std::optional<std::string> KeyReader::read(std::chrono::milliseconds at_most) {
  const auto next = [&](std::chrono::milliseconds patience) -> std::optional<char> {
    char character = 0;
    if (!wait_for_input(patience)) return std::nullopt;
    if (::read(STDIN_FILENO, &character, 1) == 1) return character;
    at_end_ = true;
    return std::nullopt;
  };
  const std::optional<char> first = next(at_most);
  if (!first) return std::nullopt;
  if (*first == ' ') return "space";
  if (*first != escape) return std::string(1, *first);
  // ESC [ A or ESC O A is an arrow key; longer sequences are other keys.
  std::optional<char> last = next(rest_of_a_sequence);
  if (!last || (*last != '[' && *last != 'O')) return std::nullopt;
  bool is_short = true;
  for (last = next(rest_of_a_sequence); last && !ends_a_sequence(*last); last = next(rest_of_a_sequence))
    is_short = false;
  return last && is_short ? arrow(*last) : std::nullopt;
}

}  // namespace cohort::tool
