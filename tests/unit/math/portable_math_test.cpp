// SPDX-License-Identifier: Apache-2.0

// The functions of client_sdk/math compared with MPFR, which computes any number of digits.

#include <gtest/gtest.h>

#ifdef COHORT_MPFR

#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace cohort {
namespace {

// A number of 200 bits.
class Exact {
 public:
  Exact() { mpfr_init2(value_, 200); }
  explicit Exact(double value) : Exact() { mpfr_set_d(value_, value, MPFR_RNDN); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(value_); }
  mpfr_ptr get() { return value_; }

  /// Returns how far a double is from it, in units of the last place of the nearest double.
  double error_of(double computed) {
    if (mpfr_nan_p(value_) != 0 || std::isnan(computed))
      return mpfr_nan_p(value_) != 0 && std::isnan(computed) ? 0 : 1e9;
    const double nearest = mpfr_get_d(value_, MPFR_RNDN);
    if (std::isinf(nearest) || std::isinf(computed)) return nearest == computed ? 0.0 : 1e9;
    constexpr long least = -1074;
    const long exponent = nearest == 0.0 ? least : std::max(least, std::ilogb(nearest) - 52L);
    Exact difference;
    mpfr_sub_d(difference.get(), value_, computed, MPFR_RNDN);
    mpfr_mul_2si(difference.get(), difference.get(), -exponent, MPFR_RNDN);
    return std::abs(mpfr_get_d(difference.get(), MPFR_RNDN));
  }

 private:
  mpfr_t value_{};
};

// Random arguments, as many as a test needs.
class Arguments {
 public:
  explicit Arguments(std::uint64_t seed) : bits_(seed) {}

  /// Returns a number of any magnitude from 2^-1074 to 2^1024, of any sign.
  double any() {
    for (;;)
      if (const auto x = std::bit_cast<double>(bits_()); std::isfinite(x)) return x;
  }
  double between(double from, double to) { return std::uniform_real_distribution<double>(from, to)(bits_); }
  /// Returns a number whose magnitude is from 2^-1074 to 1.
  double below_one() {
    for (;;)
      if (const double x = any(); std::abs(x) <= 1.0) return x;
  }
  /// Returns the double that is nearest to a multiple of pi/2, where most digits cancel.
  double near_quarter_turn() {
    Exact turns(std::floor(std::exp2(between(0.0, 60.0))));
    mpfr_mul(turns.get(), turns.get(), half_pi_.get(), MPFR_RNDN);
    const double x = mpfr_get_d(turns.get(), MPFR_RNDN);
    return bits_() % 2 == 0 ? x : -x;
  }
  double angle(std::uint64_t i) {
    switch (i % 4) {
      case 0: return any();
      case 1: return near_quarter_turn();
      case 2: return between(-10.0, 10.0);
      default: return std::exp2(between(0.0, 64.0));
    }
  }

 private:
  struct HalfPi : Exact {
    HalfPi() {
      mpfr_const_pi(get(), MPFR_RNDN);
      mpfr_div_2ui(get(), get(), 1, MPFR_RNDN);
    }
  };
  std::mt19937_64 bits_;
  HalfPi half_pi_;
};

using OfMpfr = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using OfDouble = double (*)(double);

constexpr double most_ulp = 2.0;

void expect_right(const char* name, OfDouble ours, OfMpfr theirs, double x) {
  Exact exact(x);
  theirs(exact.get(), exact.get(), MPFR_RNDN);
  ASSERT_LE(exact.error_of(ours(x)), most_ulp) << name << "(" << std::hexfloat << x << "): " << ours(x);
}

// Calls each function with a share of this many arguments.
void compare(std::uint64_t arguments) {
  struct Function {
    const char* name;
    OfDouble ours;
    OfMpfr theirs;
  };
  const Function of_angles[] = {{"sin", &::sin, &mpfr_sin}, {"cos", &::cos, &mpfr_cos}, {"tan", &::tan, &mpfr_tan}};
  const Function of_sines[] = {{"asin", &::asin, &mpfr_asin}, {"acos", &::acos, &mpfr_acos}};
  const Function of_powers[] = {{"exp", &::exp, &mpfr_exp}, {"exp2", &::exp2, &mpfr_exp2}};
  const Function of_any[] = {{"atan", &::atan, &mpfr_atan},
                             {"log", &::log, &mpfr_log},
                             {"log2", &::log2, &mpfr_log2},
                             {"log10", &::log10, &mpfr_log10}};
  Arguments draw(arguments);
  constexpr std::uint64_t results_a_round = 16;
  for (std::uint64_t i = 0; i < arguments / results_a_round; ++i) {
    const double angle = draw.angle(i), second_angle = draw.any();
    for (const auto& [name, ours, theirs] : of_angles) {
      expect_right(name, ours, theirs, angle);
      expect_right(name, ours, theirs, second_angle);
    }
    const double sine = i % 2 == 0 ? draw.between(-1.0, 1.0) : draw.below_one();
    for (const auto& [name, ours, theirs] : of_sines) expect_right(name, ours, theirs, sine);
    const double power = i % 2 == 0 ? draw.between(-1100.0, 1100.0) : draw.any();
    for (const auto& [name, ours, theirs] : of_powers) expect_right(name, ours, theirs, power);
    const double any = i % 2 == 0 ? draw.any() : draw.between(-3.0, 3.0);
    for (const auto& [name, ours, theirs] : of_any)
      expect_right(name, ours, theirs, name == std::string("atan") ? any : std::abs(any));

    const double y = draw.any(), x = i % 2 == 0 ? draw.any() : y * draw.between(-3.0, 3.0);
    Exact angle_of(y), base(x);
    mpfr_atan2(angle_of.get(), angle_of.get(), base.get(), MPFR_RNDN);
    ASSERT_LE(angle_of.error_of(::atan2(y, x)), most_ulp) << "atan2(" << std::hexfloat << y << ", " << x << ")";

    const double positive = std::abs(x),
                 exponent = draw.between(-1100.0, 1100.0) / std::max(1.0, std::abs(::log2(positive)));
    Exact result(exponent);
    Exact of(positive);
    mpfr_pow(result.get(), of.get(), result.get(), MPFR_RNDN);
    ASSERT_LE(result.error_of(::pow(positive, exponent)), most_ulp)
        << "pow(" << std::hexfloat << positive << ", " << exponent << ")";
    if (testing::Test::HasFailure()) return;
  }
}

TEST(MathematicalFunctions, AreRightForArgumentsOfAllMagnitudes) { compare(200'000); }

TEST(TwoMillionArguments, OfMathematicalFunctionsGiveTheRightResults) { compare(2'000'000); }

// The double whose distance from a multiple of pi/2 is smallest relative to its last place, and others that are known.
TEST(MathematicalFunctions, AreRightForTheAnglesThatAreHardestToReduce) {
  for (const double x : {6381956970095103.0 * 0x1p797, 0x1.6ac5b262ca1ffp+849, 1e15, 1e22, 1e50, 1e300, 0x1p1023,
                         0x1.fffffffffffffp1023, 0x1p22 * M_PI_2, 0x1p21 * M_PI_2, 1e6, M_PI, M_PI_2, 100 * M_PI})
    for (const double angle : {x, -x, std::nextafter(x, 0.0)}) {
      expect_right("sin", &::sin, &mpfr_sin, angle);
      expect_right("cos", &::cos, &mpfr_cos, angle);
      expect_right("tan", &::tan, &mpfr_tan, angle);
    }
}

}  // namespace
}  // namespace cohort

#else

TEST(MathematicalFunctions, AreRightForArgumentsOfAllMagnitudes) { GTEST_SKIP() << "libmpfr-dev is missing"; }

#endif
