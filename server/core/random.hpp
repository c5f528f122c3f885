// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace cohort {

/// Returns a 64-bit hash of a name that is the same on every machine and in every build.
std::uint64_t hash_name(std::string_view name);

/// Counter-based random numbers (Philox4x32-10, Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011):
/// a pure function of seed, stream, tick and draw. It stores nothing, so the order of calls and the number of threads
/// do not matter. Each device of each robot, and any other source of randomness, has its own stream.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view owner, std::string_view device);

  /// Returns 64 random bits.
  std::uint64_t bits(std::uint64_t tick, std::uint32_t draw) const;
  /// Returns a number in [0, 1), with 53 random bits.
  double uniform(std::uint64_t tick, std::uint32_t draw) const;
  /// Returns a normally distributed number with mean 0 and standard deviation 1 (Box and Muller 1958).
  double normal(std::uint64_t tick, std::uint32_t draw) const;

 private:
  std::uint64_t key_;
};

}  // namespace cohort
