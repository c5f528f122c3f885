#pragma once

#include <cstdint>
#include <string_view>

namespace cohort {

/// 64-bit hash of a name: the same on every machine and in every build.
std::uint64_t hash_name(std::string_view name);

/// Counter-based random numbers (Philox4x32-10, Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011):
/// a pure function of seed, stream, tick and draw. Nothing is stored, so the order of calls and the number of threads
/// cannot matter. A stream is one device of one robot, or whatever else draws.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view owner, std::string_view device);

  /// 64 random bits.
  std::uint64_t bits(std::uint64_t tick, std::uint32_t draw) const;
  /// In [0, 1), with 53 random bits.
  double uniform(std::uint64_t tick, std::uint32_t draw) const;
  /// Mean 0, standard deviation 1 (Box and Muller 1958).
  double normal(std::uint64_t tick, std::uint32_t draw) const;

 private:
  std::uint64_t key_;
};

}  // namespace cohort
