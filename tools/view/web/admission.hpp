// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::view {

/// The relevant parts of a request for a WebSocket.
struct Visitor {
  std::string host;                   ///< header Host: the address at which the browser reached this server
  std::optional<std::string> origin;  ///< header Origin: origin of the requesting page; programs send none
  std::string target;                 ///< target of the request, with its query
};

/// Conditions for a connection.
struct Admission {
  bool is_loopback = true;             ///< other machines cannot connect
  std::string token{};                 ///< empty: no token is required
  std::vector<std::string> origins{};  ///< origins of other pages that may connect
};

/// Returns whether a request's host is allowed. On the loopback interface, it must be a name of this machine. Otherwise
/// a foreign page whose host name resolves to this machine could connect (DNS rebinding).
bool is_own_host(const Admission& admission, std::string_view host);

/// Returns the reason why a visitor is rejected; nullopt if it is admitted. A page must come from this server or from
/// one of `origins`.
std::optional<std::string> refusal(const Admission& admission, const Visitor& visitor);

/// Returns 128 random bits as hexadecimal digits.
std::string random_token();

}  // namespace cohort::view
