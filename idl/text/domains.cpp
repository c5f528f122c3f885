// SPDX-License-Identifier: Apache-2.0
#include "idl/text/domains.hpp"

#include <unistd.h>

#include <charconv>
#include <optional>
#include <stdexcept>
#include <string>

namespace cohort {
namespace {

constexpr std::uint32_t last_domain = 230;

std::optional<std::uint32_t> parse_number(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number > last_domain) return std::nullopt;
  return number;
}

}  // namespace

std::vector<std::uint32_t> parse_domains(std::string_view text) {
  const auto dots = text.find("..");
  const auto first = parse_number(text.substr(0, dots));
  const auto last = dots == std::string_view::npos ? first : parse_number(text.substr(dots + 2));
  if (!first || !last || *last < *first) {
    throw std::invalid_argument("expected a domain from 0 to " + std::to_string(last_domain) +
                                ", or a range such as 7..14, not '" + std::string(text) + "'");
  }
  std::vector<std::uint32_t> domains;
  for (std::uint32_t domain = *first; domain <= *last; ++domain) domains.push_back(domain);
  return domains;
}

std::uint32_t domain_of_this_process(const std::vector<std::uint32_t>& domains) {
  return domains[static_cast<std::size_t>(::getpid()) % domains.size()];
}

}  // namespace cohort
