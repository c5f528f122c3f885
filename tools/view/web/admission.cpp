// SPDX-License-Identifier: Apache-2.0
#include "tools/view/web/admission.hpp"

#include <algorithm>
#include <array>
#include <random>

namespace cohort::view {
namespace {

std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

std::string_view token_in(std::string_view target) {
  constexpr std::string_view key = "token=";
  std::size_t begin = target.find('?');
  while (begin != std::string_view::npos) {
    const std::string_view pair = target.substr(begin + 1, target.find('&', begin + 1) - begin - 1);
    if (pair.starts_with(key)) return pair.substr(key.size());
    begin = target.find('&', begin + 1);
  }
  return {};
}

// In a time that says nothing of where they differ.
bool is_same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

}  // namespace

bool is_own_host(const Admission& admission, std::string_view host) {
  constexpr std::array<std::string_view, 3> own = {"localhost", "127.0.0.1", "[::1]"};
  return !admission.is_loopback || std::ranges::find(own, without_port(host)) != own.end();
}

std::optional<std::string> refusal(const Admission& admission, const Visitor& visitor) {
  if (!is_own_host(admission, visitor.host)) return "this server accepts only browsers on its own machine";
  if (visitor.origin && *visitor.origin != "http://" + visitor.host &&
      std::ranges::find(admission.origins, *visitor.origin) == admission.origins.end())
    return "pages from " + *visitor.origin + " may not connect: 'cohort view --origin' allows an origin";
  if (!admission.token.empty() && !is_same_secret(token_in(visitor.target), admission.token))
    return "the token is missing or wrong: use the address that 'cohort view' has printed";
  return std::nullopt;
}

std::string random_token() {
  constexpr std::string_view digits = "0123456789abcdef";
  std::random_device device;
  std::string token(32, '0');
  for (char& digit : token) digit = digits[device() % digits.size()];
  return token;
}

}  // namespace cohort::view
