// SPDX-License-Identifier: Apache-2.0
#include "server/core/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "server/core/hash.hpp"

namespace cohort {

std::uint64_t hash_name(std::string_view name) {
  StateHash hash;
  for (const char c : name) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return hash.value();
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view owner, std::string_view device) {
  StateHash hash;
  hash.add(seed);
  hash.add(hash_name(owner));
  hash.add(hash_name(device));
  key_ = hash.value();
}

std::uint64_t RandomStream::bits(std::uint64_t tick, std::uint32_t draw) const {
  const r123::Philox4x32::key_type key{{static_cast<std::uint32_t>(key_), static_cast<std::uint32_t>(key_ >> 32)}};
  const r123::Philox4x32::ctr_type counter{
      {static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32), draw, 0}};
  const auto block = r123::Philox4x32{}(counter, key);
  return static_cast<std::uint64_t>(block[1]) << 32 | block[0];
}

double RandomStream::uniform(std::uint64_t tick, std::uint32_t draw) const {
  return static_cast<double>(bits(tick, draw) >> 11) * 0x1p-53;
}

double RandomStream::normal(std::uint64_t tick, std::uint32_t draw) const {
  const std::uint64_t random = bits(tick, draw);
  // Two 32-bit uniform numbers; the first is in (0, 1], so that its logarithm is finite.
  const double first = (static_cast<double>(random & 0xffffffffu) + 1.0) * 0x1p-32;
  const double second = static_cast<double>(random >> 32) * 0x1p-32;
  return std::sqrt(-2.0 * std::log(first)) * std::cos(2.0 * std::numbers::pi * second);
}

}  // namespace cohort
