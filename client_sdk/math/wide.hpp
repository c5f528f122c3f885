// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// A double-double number with about 106 significant bits: the sum of both members. `low` is at most half a unit in the
/// last place of `high`. Sums and products follow T. J. Dekker, A floating-point technique for extending the available
/// precision, 1971.
struct Wide {
  double high;
  double low;
};

inline Wide quick_sum(double larger, double smaller) {
  const double sum = larger + smaller;
  return {sum, smaller - (sum - larger)};
}

inline Wide sum_of(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

inline Wide product_of(double a, double b) {
  const auto halves = [](double x) {
    const double scaled = 134217729.0 * x;  // 2^27 + 1
    const double high = scaled - (scaled - x);
    return Wide{high, x - high};
  };
  const Wide x = halves(a), y = halves(b);
  const double product = a * b;
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

inline Wide operator+(Wide a, Wide b) {
  const Wide sum = sum_of(a.high, b.high);
  return quick_sum(sum.high, sum.low + (a.low + b.low));
}

inline Wide operator*(Wide a, Wide b) {
  const Wide product = product_of(a.high, b.high);
  return quick_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline Wide operator/(Wide a, Wide b) {
  const double first = a.high / b.high;
  const Wide back = Wide{first, 0.0} * b;
  const double rest = ((a.high - back.high) - back.low) + a.low;
  return quick_sum(first, rest / b.high);
}

}  // namespace cohort
