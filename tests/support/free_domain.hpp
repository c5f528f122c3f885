// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "idl/dds/transport.hpp"
#include "tests/support/file_lock.hpp"
#include "tests/support/patience.hpp"

namespace cohort::test {

/// A server on a domain that no other process uses, so that tests may run in parallel.
struct FreeDomain {
  std::uint32_t domain;
  wire::Participant server;
};

inline FreeDomain take_free_domain(std::uint32_t first = 60, std::uint32_t last = 74) {
  std::optional<FreeDomain> found;
  const auto look = [&] {
    for (std::uint32_t domain = first; domain <= last && !found; ++domain) {
      try {
        found.emplace(FreeDomain{domain, wire::Participant::server(domain)});
      } catch (const wire::DomainTaken&) {
      }
    }
    return found.has_value();
  };
  if (!eventually(look)) throw std::runtime_error("all domains for tests are taken");
  return std::move(*found);
}

/// Returns a domain without a server, which no other test of this machine uses until this process ends.
inline std::uint32_t find_empty_domain() {
  for (std::uint32_t domain = 75; domain <= 79; ++domain)
    if (lock_domain(domain) >= 0) return domain;
  throw std::runtime_error("all empty domains for tests are taken");
}

}  // namespace cohort::test
