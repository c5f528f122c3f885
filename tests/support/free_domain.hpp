#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "idl/wire.hpp"
#include "tests/support/patience.hpp"

namespace cohort::test {

/// Polls until `condition` holds; false if it does not within `at_most`.
template <class Condition>
bool eventually(Condition condition, std::chrono::milliseconds at_most = patience) {
  const auto deadline = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// A server on a domain that nobody else has, so that tests may run side by side.
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

/// A domain without a server, which no other test of this machine takes until this process ends.
inline std::uint32_t find_empty_domain() {
  for (std::uint32_t domain = 75; domain <= 79; ++domain) {
    const auto file = std::filesystem::temp_directory_path() / ("cohort-test-domain-" + std::to_string(domain));
    const int lock = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) return domain;
    if (lock >= 0) close(lock);
  }
  throw std::runtime_error("all empty domains for tests are taken");
}

}  // namespace cohort::test
