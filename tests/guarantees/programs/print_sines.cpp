// SPDX-License-Identifier: Apache-2.0

// Prints bits of the C library's own sine, cosine and arc tangent for many arguments, so that a test can see whether
// the library's variant has changed.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

int main() {
  std::uint64_t sum = 0;
  const auto add = [&sum](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    sum = sum * 31 + bits;
  };
  for (int i = 1; i < 200000; ++i) {
    volatile double x = 1e-4 * i;
    add(std::sin(x));
    add(std::cos(x));
    add(std::atan2(x, 1.0 + x * x));
  }
  std::printf("%016lx\n", static_cast<unsigned long>(sum));
}
