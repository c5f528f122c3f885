// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cohort::session {

/// Data that a server keeps until a client fetches or uses it.
struct KeptForClient {
  enum class Kind { saved_snapshot, upload, recording };
  using Time = std::chrono::nanoseconds;  ///< from a steady clock

  Kind kind{};
  std::uint64_t client = 0;
  Time since{0};
  std::size_t bytes = 0;
};

/// Returns a human-readable name, such as `saved snapshot`.
std::string name_of(KeptForClient::Kind kind);

/// Returns the oldest entries, which must be dropped so that the rest has at most `most` bytes.
std::vector<KeptForClient> what_goes(std::vector<KeptForClient> kept, std::size_t most);

}  // namespace cohort::session
