// SPDX-License-Identifier: Apache-2.0

// The reduction of M. H. Payne and R. N. Hanek, Radian reduction for trigonometric functions, 1983: x 2/pi needs only
// those digits of 2/pi that do not contribute whole turns, and enough of them below.

#include "client_sdk/math/angle_reduction.hpp"

#include <array>
#include <bit>
#include <cstdint>

#include "client_sdk/math/wide.hpp"

namespace cohort {
namespace {

__extension__ using Product = unsigned __int128;

// The binary digits of 2/pi after 64 zeros, which are before the point.
constexpr std::uint64_t two_over_pi[] = {
    0x0000000000000000u, 0xa2f9836e4e441529u, 0xfc2757d1f534ddc0u, 0xdb6295993c439041u, 0xfe5163abdebbc561u,
    0xb7246e3a424dd2e0u, 0x06492eea09d1921cu, 0xfe1deb1cb129a73eu, 0xe88235f52ebb4484u, 0xe99c7026b45f7e41u,
    0x3991d639835339f4u, 0x9c845f8bbdf9283bu, 0x1ff897ffde05980fu, 0xef2f118b5a0a6d1fu, 0x6d367ecf27cb09b7u,
    0x4f463f669e5fea2du, 0x7527bac7ebe5f17bu, 0x3d0739f78a5292eau, 0x6bfb5fb11f8d5d08u, 0x56033046fc7b6babu,
};

// A fraction of 192 bits: the most significant word is the last.
using Fraction = std::array<std::uint64_t, 3>;

// Returns 192 digits, `first` being the place of the first one in the table.
Fraction digits_from(int first) {
  const auto word = static_cast<std::size_t>(first / 64);
  const int shift = first % 64;
  Fraction digits{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint64_t* const at = &two_over_pi[word + 2 - i];
    digits[i] = shift == 0 ? at[0] : at[0] << shift | at[1] >> (64 - shift);
  }
  return digits;
}

// Returns the product without the digits that exceed the fraction.
Fraction product_of(std::uint64_t factor, const Fraction& digits) {
  Fraction result{};
  Product carry = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    carry += static_cast<Product>(factor) * digits[i];
    result[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return result;
}

Fraction negated(const Fraction& fraction) {
  Fraction result{};
  std::uint64_t carry = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = ~fraction[i] + carry;
    carry = static_cast<std::uint64_t>(carry == 1 && result[i] == 0);
  }
  return result;
}

Fraction shifted_left(const Fraction& fraction, int bits) {
  Fraction shifted = fraction;
  for (; bits >= 64; bits -= 64) shifted = {0, shifted[0], shifted[1]};
  if (bits == 0) return shifted;
  return {shifted[0] << bits, shifted[1] << bits | shifted[0] >> (64 - bits),
          shifted[2] << bits | shifted[1] >> (64 - bits)};
}

double power_of_two(int exponent) { return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52); }

Wide number_of(const Fraction& fraction) {
  int zeros = 0;
  while (zeros < 128 && fraction[2 - static_cast<std::size_t>(zeros) / 64] == 0) zeros += 64;
  zeros += std::countl_zero(fraction[2 - static_cast<std::size_t>(zeros) / 64]);
  const Fraction digits = shifted_left(fraction, zeros);
  const std::uint64_t rest = digits[2] << 53 | digits[1] >> 11;
  return quick_sum(static_cast<double>(digits[2] >> 11) * power_of_two(-53 - zeros),
                   static_cast<double>(rest) * power_of_two(-117 - zeros));
}

}  // namespace

ReducedAngle reduce_exactly(double x) {
  constexpr Wide half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1023 - 52;  // x = mantissa 2^exponent
  const std::uint64_t mantissa = (bits & 0x000fffffffffffffu) | 0x0010000000000000u;
  // Digit i of 2/pi contributes mantissa 2^(exponent - i) quarter turns: below i = exponent - 1, whole turns.
  constexpr int before_first_digit = 63;
  const Fraction turns = product_of(mantissa, digits_from(exponent - 1 + before_first_digit));
  int quadrant = static_cast<int>(turns[2] >> 62);
  Fraction rest = shifted_left(turns, 2);
  const bool is_past_half = rest[2] >> 63 != 0;
  if (is_past_half) {
    ++quadrant;
    rest = negated(rest);
  }
  Wide angle = number_of(rest) * half_pi;
  if (is_past_half != (x < 0.0)) angle = {-angle.high, -angle.low};
  return {(x < 0.0 ? -quadrant : quadrant) & 3, angle.high, angle.low};
}

}  // namespace cohort
