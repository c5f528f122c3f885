// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Arithmetic on vectors whose length is a multiple of `lanes`, always with `lanes` partial sums. The result has the
/// same bits for any SIMD width that the compiler chooses.
namespace cohort::physics {

inline constexpr std::ptrdiff_t lanes = 4;

/// Converts a signed index to one of the standard library.
inline std::size_t at(std::ptrdiff_t index) { return static_cast<std::size_t>(index); }

/// Half of `lanes`, which fits into a register of every x86-64 CPU.
using Half = double __attribute__((vector_size(16)));
using HalfInMemory = double __attribute__((vector_size(16), aligned(8), may_alias));

inline Half load(const double* from) { return *reinterpret_cast<const HalfInMemory*>(from); }
inline void store(Half half, double* to) { *reinterpret_cast<HalfInMemory*>(to) = half; }

inline double dot(const double* a, const double* b, std::ptrdiff_t length) {
  Half low = load(a) * load(b);
  Half high = load(a + 2) * load(b + 2);
  for (std::ptrdiff_t i = lanes; i < length; i += lanes) {
    low += load(a + i) * load(b + i);
    high += load(a + i + 2) * load(b + i + 2);
  }
  const Half pair = low + high;
  return pair[0] + pair[1];
}

/// Computes y += factor * x.
inline void add_scaled(double factor, const double* x, double* y, std::ptrdiff_t length) {
  for (std::ptrdiff_t i = 0; i < length; i += lanes) {
    store(load(y + i) + factor * load(x + i), y + i);
    store(load(y + i + 2) + factor * load(x + i + 2), y + i + 2);
  }
}

}  // namespace cohort::physics
