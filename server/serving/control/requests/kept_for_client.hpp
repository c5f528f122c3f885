#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cohort::session {

/// Something that a server keeps until a client fetches or uses it.
struct KeptForClient {
  enum class Kind { saved_snapshot, upload, recording };
  using Time = std::chrono::nanoseconds;  ///< of a steady clock

  Kind kind{};
  std::uint64_t client = 0;
  Time since{0};
  std::size_t bytes = 0;
};

/// For people, such as `snapshot`.
std::string name_of(KeptForClient::Kind kind);

/// What has to go, the oldest first, so that the rest has at most `most` bytes.
std::vector<KeptForClient> what_goes(std::vector<KeptForClient> kept, std::size_t most);

}  // namespace cohort::session
