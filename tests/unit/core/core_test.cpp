#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <set>

#include "client_sdk/math/portable_math.hpp"
#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/core/worker_pool.hpp"

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

TEST(WorkerPool, CoversEveryIndexOnceInChunksThatDoNotDependOnThreads) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    WorkerPool workers(threads);
    std::vector<std::atomic<int>> visits(1003);
    workers.for_each_chunk(visits.size(), 10, [&](std::size_t begin, std::size_t end, unsigned worker) {
      EXPECT_EQ(begin % 10, 0u);
      EXPECT_LE(end - begin, 10u);
      EXPECT_LT(worker, threads);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(WorkerPool, PassesAnExceptionOn) {
  WorkerPool workers(2);
  EXPECT_THROW(workers.for_each_chunk(100, 1,
                                      [](std::size_t begin, std::size_t, unsigned) {
                                        if (begin == 50) throw std::runtime_error("no");
                                      }),
               std::runtime_error);
}

TEST(PortableMath, IsWhatEveryLibraryOfThisProgramCalls) { EXPECT_TRUE(functions_not_portable().empty()); }

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
                                           UnaryCase{"log", &::log, 0, 1e-3}, UnaryCase{"log", &::log, 0.5, 2}),
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

}  // namespace
}  // namespace cohort
