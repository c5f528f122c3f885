// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/math/portable_power.hpp"

#include <bit>
#include <cstdint>
#include <limits>

#include "client_sdk/math/wide.hpp"

namespace cohort {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr Wide ln_2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr Wide log2_e = {0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56};
constexpr Wide log10_e = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};

// A positive number as m 2^exponent, with m from sqrt(1/2) to sqrt(2).
struct Split {
  double m;
  int exponent;
};
Split split(double x) {
  int exponent = -1023;
  if (x < 0x1p-1022) {  // subnormal
    x *= 0x1p54;
    exponent -= 54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> 52);
  const auto m = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
  return m > 1.41421356237309504880 ? Split{0.5 * m, exponent + 1} : Split{m, exponent};
}

// Returns ln(m) for sqrt(1/2) <= m <= sqrt(2) as 2 atanh(s) = 2 (s + s^3/3 + s^5/5 + ...), with s = (m - 1) / (m + 1)
// and s^2 < 0.03.
Wide log_of_mantissa(double m) {
  const Wide s = sum_of(m, -1.0) / sum_of(m, 1.0);
  const Wide z = s * s;
  Wide sum = {0.0, 0.0};
  for (int odd = 43; odd >= 1; odd -= 2) sum = sum * z + Wide{1.0, 0.0} / Wide{static_cast<double>(odd), 0.0};
  const Wide half = s * sum;
  return {2.0 * half.high, 2.0 * half.low};
}

// Returns x 2^exponent, also if 2^exponent is too large or too small for one factor.
double scaled(double x, int exponent) {
  const auto power = [](int n) { return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n) << 52); };
  const int half = exponent / 2;
  return x * power(half) * power(exponent - half);
}

// Returns e^x for |x| <= 746 as 2^k e^r with |r| <= ln(2) / 2, r = x - k ln(2), and the Taylor series of r / 16.
double exp_of(Wide x) {
  const double k = __builtin_rint(x.high * log2_e.high);
  const Wide r = x + Wide{-k, 0.0} * ln_2;
  const Wide small = {0.0625 * r.high, 0.0625 * r.low};
  Wide sum = {1.0, 0.0};
  for (int n = 16; n >= 1; --n) sum = Wide{1.0, 0.0} + (small / Wide{static_cast<double>(n), 0.0}) * sum;
  for (int squaring = 0; squaring < 4; ++squaring) sum = sum * sum;
  return scaled(sum.high + sum.low, static_cast<int>(k));
}

double exp_of_product(double y, Wide logarithm) {
  constexpr double beyond = 746.0;  // e^746 is infinite, e^-746 zero
  // For a greater y, the product of the halves would overflow; any logarithm except 0 is at least 2^-53.
  if (__builtin_fabs(y) > 0x1p64 || __builtin_fabs(y * logarithm.high) > beyond)
    return (y > 0.0) == (logarithm.high > 0.0) ? infinite : 0.0;
  return exp_of(Wide{y, 0.0} * logarithm);
}

bool is_whole(double x) { return __builtin_trunc(x) == x; }
bool is_odd(double x) { return is_whole(x) && !is_whole(0.5 * x); }

Wide log_of_positive(double x) {
  const auto [m, exponent] = split(x);
  return Wide{static_cast<double>(exponent), 0.0} * ln_2 + log_of_mantissa(m);
}

// Logarithms, to any base, of zero, infinity, NaN and negative numbers.
bool is_special(double x) { return !(x > 0.0 && x < infinite); }
double special_log(double x) {
  if (x == 0.0) return -infinite;
  return x < 0.0 ? not_a_number : x;
}

}  // namespace

// The special cases are those of IEC 60559, as in the C library.
double portable_pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (x != x || y != y) return x + y;
  const double magnitude = __builtin_fabs(x);
  if (magnitude == 1.0 && __builtin_fabs(y) == infinite) return 1.0;
  const bool is_negative = __builtin_signbit(x) != 0 && is_odd(y);
  double result = 0.0;
  if (magnitude == 0.0 || magnitude == infinite || __builtin_fabs(y) == infinite) {
    result = (magnitude > 1.0) == (y > 0.0) ? infinite : 0.0;
  } else if (x < 0.0 && !is_whole(y)) {
    return not_a_number;
  } else if (magnitude == 1.0) {
    result = 1.0;
  } else {
    result = exp_of_product(y, log_of_positive(magnitude));
  }
  return is_negative ? -result : result;
}

double portable_log2(double x) {
  if (is_special(x)) return special_log(x);
  const auto [m, exponent] = split(x);
  const Wide sum = Wide{static_cast<double>(exponent), 0.0} + log_of_mantissa(m) * log2_e;
  return sum.high + sum.low;
}

double portable_log10(double x) {
  if (is_special(x)) return special_log(x);
  const Wide product = log_of_positive(x) * log10_e;
  return product.high + product.low;
}

}  // namespace cohort
