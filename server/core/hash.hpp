// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace cohort {

/// Accumulates 64-bit words into a 64-bit hash that depends on their values and order, with the body and finaliser of
/// MurmurHash3 (Appleby, public domain). Doubles are hashed by their bits, so -0.0 and 0.0 differ.
class StateHash {
 public:
  void add(std::uint64_t word) {
    word *= 0x87c37b91114253d5u;
    word = std::rotl(word, 31);
    word *= 0x4cf5ad432745937fu;
    hash_ ^= word;
    hash_ = std::rotl(hash_, 27) * 5 + 0x52dce729u;
    ++count_;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

  std::uint64_t value() const {
    std::uint64_t h = hash_ ^ count_;
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 33;
    h *= 0xc4ceb9fe1a85ec53u;
    h ^= h >> 33;
    return h;
  }

 private:
  std::uint64_t hash_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace cohort
