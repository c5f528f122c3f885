// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/page_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cohort::tool {
namespace {

constexpr std::size_t longest_line = 116;

}  // namespace

std::string made_from(std::string_view tables) {
  return fmt::format(
      "<!-- `cohort help --markdown docs/reference` writes this page. Edit the tables in {} instead. -->\n", tables);
}

std::string wrapped(std::string_view text, std::string_view indent) {
  std::string result;
  std::size_t begin = 0;
  std::size_t column = 0;
  while (begin < text.size()) {
    std::size_t end = begin;
    for (bool in_code = false; end < text.size() && (in_code || text[end] != ' '); ++end)
      if (text[end] == '`') in_code = !in_code;
    const std::string_view word = text.substr(begin, end - begin);
    const auto width = static_cast<std::size_t>(
        std::ranges::count_if(word, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
    if (column > 0 && column + 1 + width > longest_line) {
      result += fmt::format("\n{}", indent);
      column = indent.size();
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result += word;
    column += width;
    begin = end + 1;
  }
  return result;
}

std::string anchor_of(std::string_view title) {
  std::string anchor;
  for (const char c : title) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-') anchor += c;
    if (c >= 'A' && c <= 'Z') anchor += static_cast<char>(c - 'A' + 'a');
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

}  // namespace cohort::tool
