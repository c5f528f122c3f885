#pragma once

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <thread>

#include "idl/wire.hpp"

namespace cohort::test {

/// A server on a domain that nobody else has, so that tests may run side by side.
struct FreeDomain {
  std::uint32_t domain;
  wire::Participant server;
};

inline FreeDomain take_free_domain() {
  for (std::uint32_t domain = 60; domain < 80; ++domain) {
    try {
      return {domain, wire::Participant::server(domain)};
    } catch (const wire::DomainTaken&) {
    }
  }
  throw std::runtime_error("domains 60 to 79 are all taken");
}

/// Polls until `condition` holds; false if it does not within `at_most`.
template <class Condition>
bool eventually(Condition condition, std::chrono::milliseconds at_most = std::chrono::seconds(10)) {
  const auto deadline = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace cohort::test
