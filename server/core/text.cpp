// SPDX-License-Identifier: Apache-2.0
#include "server/core/text.hpp"

#include <algorithm>
#include <charconv>

namespace cohort {
namespace {

constexpr std::string_view white_space = " \t\r\n";

template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return number;
}

}  // namespace

std::string shortest_text(double number) {
  char text[32];
  return {std::begin(text), std::to_chars(std::begin(text), std::end(text), number).ptr};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(white_space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t length = std::min(text.find_first_of(white_space), text.size());
    found.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return found;
}

std::optional<double> parse_real(std::string_view text) {
  text = trimmed(text);
  // from_chars does not accept a plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return parse<double>(text);
}

std::optional<std::uint64_t> parse_whole(std::string_view text) { return parse<std::uint64_t>(trimmed(text)); }

std::optional<std::string> nearest(std::string_view unknown, const std::vector<std::string>& known) {
  const std::size_t slip = std::max<std::size_t>(2, unknown.size() / 3);
  const std::string* found = nullptr;
  std::size_t least = slip + 1;
  for (const std::string& name : known) {
    if (const std::size_t distance = edit_distance(unknown, name); distance < least) {
      least = distance;
      found = &name;
    }
  }
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::string suggestion(std::string_view unknown, const std::vector<std::string>& known) {
  constexpr std::size_t few = 16;
  if (const auto name = nearest(unknown, known)) return "; did you mean '" + *name + "'?";
  if (known.empty() || known.size() > few) return {};
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  return "; known: " + list;
}

}  // namespace cohort
