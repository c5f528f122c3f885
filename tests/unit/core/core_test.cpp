// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <set>

#include "client_sdk/math/portable_math.hpp"
#include "server/core/hash.hpp"
#include "server/core/random.hpp"

namespace cohort {
namespace {

TEST(RandomStream, IsAPureFunctionOfItsArguments) {
  const RandomStream first(1, "team/sbot_3", "proximity");
  const RandomStream again(1, "team/sbot_3", "proximity");
  EXPECT_EQ(first.bits(17, 4), again.bits(17, 4));
  EXPECT_EQ(first.normal(17, 4), again.normal(17, 4));
}

TEST(RandomStream, DiffersBySeedOwnerDeviceTickAndDraw) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {1u, 2u})
    for (const char* owner : {"a", "b"})
      for (const char* device : {"x", "y"})
        for (const std::uint64_t tick : {0u, 1u})
          for (const std::uint32_t draw : {0u, 1u}) seen.insert(RandomStream(seed, owner, device).bits(tick, draw));
  EXPECT_EQ(seen.size(), 32u);
}

TEST(RandomStream, GivesUniformNumbersWithTheirMomentsAndRange) {
  const RandomStream random(42, "owner", "device");
  double sum = 0.0, squares = 0.0;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(static_cast<std::uint64_t>(i), 0);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.005);
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 0.005);
}

TEST(RandomStream, GivesNormalNumbersWithTheirMoments) {
  const RandomStream random(42, "owner", "device");
  double sum = 0.0, squares = 0.0, fourths = 0.0;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal(static_cast<std::uint64_t>(i), 3);
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0.0, 0.015);
  EXPECT_NEAR(squares / n, 1.0, 0.02);
  EXPECT_NEAR(fourths / n, 3.0, 0.15);
}

TEST(StateHash, DependsOnValuesOrderAndCount) {
  const auto hash_of = [](std::initializer_list<double> values) {
    StateHash hash;
    for (const double value : values) hash.add(value);
    return hash.value();
  };
  EXPECT_EQ(hash_of({1.0, 2.0}), hash_of({1.0, 2.0}));
  EXPECT_NE(hash_of({1.0, 2.0}), hash_of({2.0, 1.0}));
  EXPECT_NE(hash_of({1.0}), hash_of({1.0, 0.0}));
  EXPECT_NE(hash_of({0.0}), hash_of({-0.0}));
  EXPECT_NE(hash_of({1.0}), hash_of({std::nextafter(1.0, 2.0)})) << "one bit counts";
}

TEST(PortableMath, IsUsedByEveryLibraryOfThisProgram) { EXPECT_TRUE(functions_not_portable().empty()); }

// The C library's own function, which ours hide.
template <class Function>
Function of_c_library(const char* name) {
  static void* library = dlopen("libm.so.6", RTLD_NOW);
  return reinterpret_cast<Function>(dlsym(library, name));
}

using Unary = double (*)(double);
struct UnaryCase {
  const char* name;
  Unary ours;
  double from, to;
};

class PortableUnary : public ::testing::TestWithParam<UnaryCase> {};

TEST_P(PortableUnary, AgreesWithTheCLibraryWithinTwoUlp) {
  const UnaryCase& c = GetParam();
  const auto theirs = of_c_library<Unary>(c.name);
  ASSERT_NE(theirs, c.ours);
  const RandomStream random(3, "core_test", c.name);
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const double x = c.from + (c.to - c.from) * random.uniform(i, 0);
    const double expected = theirs(x);
    const double ulp = std::nextafter(std::fabs(expected), HUGE_VAL) - std::fabs(expected);
    ASSERT_NEAR(c.ours(x), expected, 2.01 * ulp) << c.name << "(" << x << ")";
  }
  for (const double x : {0.0, -0.0, 1.0, -1.0, HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    const double expected = theirs(x);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(c.ours(x))) << c.name << "(" << x << ")";
    } else {
      EXPECT_DOUBLE_EQ(c.ours(x), expected) << c.name << "(" << x << ")";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PortableUnary,
                         ::testing::Values(UnaryCase{"sin", &::sin, -100, 100}, UnaryCase{"sin", &::sin, -1e6, 1e6},
                                           UnaryCase{"cos", &::cos, -100, 100}, UnaryCase{"cos", &::cos, -1e6, 1e6},
                                           UnaryCase{"tan", &::tan, -1.5, 1.5}, UnaryCase{"atan", &::atan, -20, 20},
                                           UnaryCase{"asin", &::asin, -1, 1}, UnaryCase{"acos", &::acos, -1, 1},
                                           UnaryCase{"exp", &::exp, -700, 700}, UnaryCase{"exp", &::exp, -1, 1},
                                           UnaryCase{"log", &::log, 0, 1e-3}, UnaryCase{"log", &::log, 0.5, 2},
                                           UnaryCase{"log2", &::log2, 0, 10}, UnaryCase{"log10", &::log10, 0, 10},
                                           UnaryCase{"exp2", &::exp2, -1000, 1000}),
                         [](const auto& unary) { return std::string(unary.param.name) + std::to_string(unary.index); });

TEST(PortableMath, Atan2AgreesWithTheCLibraryInEveryQuadrantAndCorner) {
  const auto theirs = of_c_library<double (*)(double, double)>("atan2");
  const RandomStream random(3, "core_test", "atan2");
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const double y = 2 * random.uniform(i, 0) - 1, x = 2 * random.uniform(i, 1) - 1;
    const double expected = theirs(y, x);
    ASSERT_NEAR(::atan2(y, x), expected, 2.01 * (std::nextafter(std::fabs(expected), 4.0) - std::fabs(expected)));
  }
  const double corners[] = {0.0, -0.0, 1.0, -1.0, HUGE_VAL, -HUGE_VAL, 1e-300, 1e300};
  for (const double y : corners)
    for (const double x : corners) {
      EXPECT_DOUBLE_EQ(::atan2(y, x), theirs(y, x)) << y << ", " << x;
      EXPECT_EQ(std::signbit(::atan2(y, x)), std::signbit(theirs(y, x))) << y << ", " << x;
    }
}

TEST(PortableMath, PowAgreesWithTheCLibraryWithinAnUlpAndInEveryCorner) {
  const auto theirs = of_c_library<double (*)(double, double)>("pow");
  const RandomStream random(3, "core_test", "pow");
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    const double x = ::exp(20.0 * random.uniform(i, 0) - 10.0), y = 60.0 * random.uniform(i, 1) - 30.0;
    const double expected = theirs(x, y);
    ASSERT_NEAR(::pow(x, y), expected, 1.01 * (std::nextafter(expected, HUGE_VAL) - expected)) << x << ", " << y;
  }
  const double corners[] = {0.0,   -0.0, 0.5,  -0.5,   1.0,    -1.0,   2.0,   -2.0,     3.0,       -3.0,        1e-300,
                            1e300, -1e3, 1e19, 5e-324, -1e300, 1074.0, -1e-3, HUGE_VAL, -HUGE_VAL, std::nan("")};
  for (const double x : corners)
    for (const double y : corners) {
      const double expected = theirs(x, y);
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(::pow(x, y))) << x << ", " << y;
      } else {
        EXPECT_DOUBLE_EQ(::pow(x, y), expected) << x << ", " << y;
        EXPECT_EQ(std::signbit(::pow(x, y)), std::signbit(expected)) << x << ", " << y;
      }
    }
}

TEST(PortableMath, RepresentableIntegerPowersAreExact) {
  for (int base = 1; base <= 100; ++base) {
    double power = 1.0;
    for (int exponent = 0; power < 0x1p53; ++exponent, power *= base) {
      EXPECT_EQ(::pow(base, exponent), power) << base << ", " << exponent;
      if (base == 1) break;
      if (base == 10) {
        EXPECT_EQ(::log10(power), exponent);
      }
      if (base == 2) {
        EXPECT_EQ(::log2(power), exponent);
      }
    }
  }
}

TEST(PortableMath, FunctionsOfFloatAreThoseOfDoubleRounded) {
  using OfFloat = float (*)(float);
  const std::tuple<const char*, OfFloat, float, float> functions[] = {
      {"sinf", &::sinf, -100.0f, 100.0f}, {"cosf", &::cosf, -100.0f, 100.0f},  {"tanf", &::tanf, -1.5f, 1.5f},
      {"atanf", &::atanf, -20.0f, 20.0f}, {"asinf", &::asinf, -1.0f, 1.0f},    {"acosf", &::acosf, -1.0f, 1.0f},
      {"expf", &::expf, -80.0f, 80.0f},   {"logf", &::logf, 0.0f, 2.0f},       {"log2f", &::log2f, 0.0f, 2.0f},
      {"log10f", &::log10f, 0.0f, 2.0f},  {"exp2f", &::exp2f, -100.0f, 100.0f}};
  const RandomStream random(3, "core_test", "float");
  std::uint64_t draw = 0;
  const auto expect_near = [](const char* name, float ours, float theirs) {
    EXPECT_NEAR(ours, theirs, 2.01f * (std::nextafter(std::fabs(theirs), HUGE_VALF) - std::fabs(theirs))) << name;
  };
  for (const auto& [name, ours, from, to] : functions)
    for (int i = 0; i < 1000; ++i) {
      const float x = from + (to - from) * static_cast<float>(random.uniform(draw++, 0));
      expect_near(name, ours(x), of_c_library<OfFloat>(name)(x));
    }
  for (const char* const name : {"atan2f", "powf"}) {
    const auto ours = name == std::string("powf") ? &::powf : &::atan2f;
    const auto theirs = of_c_library<float (*)(float, float)>(name);
    for (int i = 0; i < 1000; ++i) {
      const auto x = static_cast<float>(random.uniform(draw, 0)), y = static_cast<float>(random.uniform(draw, 1));
      ++draw;
      expect_near(name, ours(x, y), theirs(x, y));
    }
  }
}

}  // namespace
}  // namespace cohort
