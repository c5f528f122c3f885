// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/bridges/common/link.hpp"

namespace cohort::bridges {

/// Returns the endpoint of an IPv4 address and a port. Throws std::runtime_error if `address` is not an IPv4 address.
sockaddr_in endpoint_of(const std::string& address, std::uint16_t port);

/// Waits for one connection at a time. Throws std::runtime_error.
std::unique_ptr<Link> listen_for_tcp(const std::string& address, std::uint16_t port);

/// Receives datagrams; with `peer`, only from there. Throws std::runtime_error.
std::unique_ptr<Link> open_udp(const std::string& address, std::uint16_t port, const std::optional<sockaddr_in>& peer);

}  // namespace cohort::bridges
