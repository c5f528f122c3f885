// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Makes untrusted text safe to print. Text is cleaned when it is received, and again before it is written to a
/// terminal.
namespace cohort {

/// The first character of a UTF-8 text.
struct TextCharacter {
  std::size_t size = 1;  ///< [bytes]; if it is not UTF-8, up to the next possible start of a character
  char32_t code = 0;
  bool is_valid = false;
};

/// Returns the first character of `text`, which is not empty: Unicode 15, table 3-7.
inline TextCharacter first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {1, lead, true};
  if (lead < 0xc2 || lead > 0xf4) return {};
  const std::size_t size = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  // Rejects overlong encodings, surrogates and code points beyond Unicode.
  const unsigned least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
  const unsigned greatest = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
  char32_t code = lead & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if (byte(i) < (i == 1 ? least : 0x80) || byte(i) > (i == 1 ? greatest : 0xbf)) return {i, 0, false};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  return {size, code, true};
}

/// Returns true if a terminal displays the character in place. Terminals execute control characters (C0, DEL, C1), and
/// reorder text after characters that set its direction.
inline bool is_shown(char32_t code) {
  const bool controls = code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029;
  const bool directs = code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                       (code >= 0x2066 && code <= 0x2069);
  return !controls && !directs;
}

enum class Lines { joined, kept };

/// Returns the text in valid UTF-8, with U+FFFD in place of characters that a terminal would execute. Tabs and line
/// ends become spaces, unless lines are kept. A text of more than `most` bytes ends with an ellipsis.
inline std::string printable(std::string_view text, std::size_t most = std::string_view::npos,
                             Lines lines = Lines::joined) {
  constexpr std::string_view replacement = "\xef\xbf\xbd";
  constexpr std::string_view ellipsis = "\xe2\x80\xa6";
  std::string result;
  std::size_t cut = 0;  // position for the ellipsis
  while (!text.empty()) {
    const TextCharacter character = first_character(text);
    std::string_view shown = text.substr(0, character.size);
    const bool is_space = shown == "\n" || shown == "\t" || shown == "\r";
    if (is_space && (lines == Lines::joined || shown == "\r"))
      shown = " ";
    else if (!is_space && (!character.is_valid || !is_shown(character.code)))
      shown = replacement;
    if (shown.size() > most - result.size()) {
      result.resize(cut);
      return most < ellipsis.size() ? result : result.append(ellipsis);
    }
    result += shown;
    if (most - result.size() >= ellipsis.size()) cut = result.size();
    text.remove_prefix(character.size);
  }
  return result;
}

}  // namespace cohort
