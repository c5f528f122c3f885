#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::view {

/// Headers of a browser's request for a WebSocket.
struct Visitor {
  std::string host;                   ///< the header Host: the page's own address as the browser knows it
  std::optional<std::string> origin;  ///< the header Origin: of the page that asks; programs send none
  std::string target;                 ///< target of the request, with its query
};

/// Conditions for a connection.
struct Admission {
  bool is_loopback = true;             ///< other machines cannot connect
  std::string token{};                 ///< empty: none is needed
  std::vector<std::string> origins{};  ///< origins of other pages that may connect
};

/// On the loopback a host has to be one of this machine's own names: otherwise a page of a stranger, whose name
/// resolves to this machine, would pass for ours.
bool is_own_host(const Admission& admission, std::string_view host);

/// Why a visitor is refused; nothing if it may come in. A page has to be ours, or one of `origins`.
std::optional<std::string> refusal(const Admission& admission, const Visitor& visitor);

/// 128 random bits as hexadecimal digits.
std::string random_token();

}  // namespace cohort::view
