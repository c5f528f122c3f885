// SPDX-License-Identifier: Apache-2.0
#include "server/core/names.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace cohort {
namespace {

constexpr std::size_t longest_name = 255;

}  // namespace

// The message does not repeat an invalid name.
void check_name(const std::string& name, const std::string& what) {
  check_utf8(name, what);
  if (name.size() > longest_name)
    throw std::invalid_argument(what + " is longer than " + std::to_string(longest_name) + " bytes");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  if (std::ranges::any_of(name, is_control)) throw std::invalid_argument(what + " contains a control character");
}

void check_utf8(const std::string& text, const std::string& what) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned first = byte(i);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    bool is_good = length > 0;
    for (std::size_t k = 1; k < length; ++k) is_good = is_good && (byte(i + k) & 0xc0) == 0x80;
    // Only shortest forms are valid, no surrogates, and nothing beyond U+10FFFF.
    if (first == 0xe0) is_good = is_good && byte(i + 1) >= 0xa0;
    if (first == 0xed) is_good = is_good && byte(i + 1) < 0xa0;
    if (first == 0xf0) is_good = is_good && byte(i + 1) >= 0x90;
    if (first == 0xf4) is_good = is_good && byte(i + 1) < 0x90;
    if (!is_good) throw std::invalid_argument(what + " is not valid UTF-8");
    i += length;
  }
}

bool is_object_name(const std::string& name) {
  try {
    check_name(name, "");
  } catch (const std::invalid_argument&) {
    return false;
  }
  return !name.empty() && name.front() != '/' && name.back() != '/' && name.find("//") == std::string::npos;
}

}  // namespace cohort
