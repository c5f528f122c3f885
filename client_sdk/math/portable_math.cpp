// SPDX-License-Identifier: Apache-2.0

// sin, cos, tan, asin, acos, atan, atan2, exp and log, implemented with + - * / and sqrt. Algorithms and coefficients
// are those of fdlibm (Sun Microsystems, 1993: k_sin.c, k_cos.c, e_rem_pio2.c, e_asin.c, s_atan.c, e_exp.c, e_log.c).
// Results are within 2 units in the last place for every argument. The functions of float round these results.
// Functions that are exact in any correct implementation, such as sqrt and fmod, remain those of the C library.

#include "client_sdk/math/portable_math.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "client_sdk/math/angle_reduction.hpp"
#include "client_sdk/math/portable_power.hpp"
#include "client_sdk/math/wide.hpp"

namespace {

using cohort::reduce_exactly;
using cohort::ReducedAngle;
using cohort::Wide;

constexpr double pi = 3.14159265358979311600e+00;
constexpr double half_pi = 1.57079632679489655800e+00;
constexpr double half_pi_low = 6.12323399573676603587e-17;  // pi/2 - half_pi

double sqrt_of(double x) { return __builtin_sqrt(x); }

// Returns sin(x + tail) for |x| <= pi/4; the sum of both members is more precise than the first.
Wide sin_parts(double x, double tail) {
  const double z = x * x;
  const double v = z * x;
  const double r =
      8.33333333332248946124e-03 +
      z * (-1.98412698298579493134e-04 +
           z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  const double rest = (z * (0.5 * tail - v * r) - tail) - v * -1.66666666666666324348e-01;
  return cohort::quick_sum(x, -rest);
}
double sin_kernel(double x, double tail) { return sin_parts(x, tail).high; }

// Returns cos(x + tail) in the same way.
Wide cos_parts(double x, double tail) {
  const double z = x * x;
  const double r = z * (4.16666666666666019037e-02 +
                        z * (-1.38888888888741095749e-03 +
                             z * (2.48015872894767294178e-05 +
                                  z * (-2.75573143513906633035e-07 +
                                       z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const double half = 0.5 * z;
  const double w = 1.0 - half;
  return cohort::quick_sum(w, ((1.0 - w) - half) + (z * r - x * tail));
}
double cos_kernel(double x, double tail) { return cos_parts(x, tail).high; }

// Returns x - n pi/2 in about 1.5 doubles (Cody and Waite in two parts) if the products below are exact.
ReducedAngle reduce(double x) {
  constexpr double inverse = 6.36619772367581382433e-01;
  constexpr double part1 = 1.57079632673412561417e+00, rest1 = 6.07710050650619224932e-11;  // part1 has 31 bits
  constexpr double part2 = 6.07710050630396597660e-11, rest2 = 2.02226624879595063154e-21;  // part2 has 32 bits
  const double n = __builtin_rint(x * inverse);
  const double count = __builtin_fabs(n);
  if (count >= 0x1p22) return reduce_exactly(x);
  double r = x - n * part1;
  double w = n * rest1;
  double value = r - w;
  // Too many bits cancelled: also subtract the second part.
  const auto exponent = [](double d) { return static_cast<int>((std::bit_cast<std::uint64_t>(d) >> 52) & 0x7ff); };
  if (exponent(x) - exponent(value) > 16) {
    if (count >= 0x1p21) return reduce_exactly(x);
    const double t = r;
    w = n * part2;
    r = t - w;
    w = n * rest2 - ((t - r) - w);
    value = r - w;
    // The parts of pi/2 are exact to 2^-122: this is not enough if nearly all bits cancelled.
    if (__builtin_fabs(value) < count * 0x1p-69) return reduce_exactly(x);
  }
  return {static_cast<int>(static_cast<std::int64_t>(n) & 3), value, (r - value) - w};
}

bool is_finite(double x) { return x - x == 0.0; }

double portable_sin(double x) {
  if (!is_finite(x)) return x - x;
  if (__builtin_fabs(x) < 0.785) return sin_kernel(x, 0.0);
  const ReducedAngle r = reduce(x);
  switch (r.quadrant) {
    case 0: return sin_kernel(r.value, r.tail);
    case 1: return cos_kernel(r.value, r.tail);
    case 2: return -sin_kernel(r.value, r.tail);
    default: return -cos_kernel(r.value, r.tail);
  }
}

double portable_cos(double x) {
  if (!is_finite(x)) return x - x;
  if (__builtin_fabs(x) < 0.785) return cos_kernel(x, 0.0);
  const ReducedAngle r = reduce(x);
  switch (r.quadrant) {
    case 0: return cos_kernel(r.value, r.tail);
    case 1: return -sin_kernel(r.value, r.tail);
    case 2: return -cos_kernel(r.value, r.tail);
    default: return sin_kernel(r.value, r.tail);
  }
}

// Returns `result`, or the better `result + error` if the error is more than `most` units in the last place.
double corrected(double result, double error, double most) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(result) & 0x7ff0000000000000u;
  const double unit = std::bit_cast<double>(exponent) * 0x1p-52;
  return __builtin_fabs(error) > most * unit ? result + error : result;
}

double portable_tan(double x) {
  if (!is_finite(x)) return x - x;
  const ReducedAngle r = __builtin_fabs(x) < 0.785 ? ReducedAngle{0, x, 0.0} : reduce(x);
  const Wide sine = sin_parts(r.value, r.tail), cosine = cos_parts(r.value, r.tail);
  const bool is_odd = (r.quadrant & 1) != 0;
  const Wide& above = is_odd ? cosine : sine;
  const Wide& below = is_odd ? sine : cosine;
  const double ratio = above.high / below.high;
  const Wide product = cohort::product_of(ratio, below.high);
  const double rest = ((above.high - product.high) - product.low) + (above.low - ratio * below.low);
  const double result = corrected(ratio, rest / below.high, 1.6);  // the error is known to 0.4 units
  return is_odd ? -result : result;
}

double portable_atan(double x) {
  constexpr double high[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01, 9.82793723247329054082e-01,
                             half_pi};
  constexpr double low[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17, 1.39033110312309984516e-17,
                            half_pi_low};
  constexpr double a[] = {3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
                          -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
                          6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
                          -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  if (x != x) return x;
  const double magnitude = __builtin_fabs(x);
  if (magnitude >= 0x1p66) return x < 0.0 ? -half_pi : half_pi;
  int table = -1;
  double t = x;
  if (magnitude >= 2.4375) {
    table = 3;
    t = -1.0 / magnitude;
  } else if (magnitude >= 1.1875) {
    table = 2;
    t = (magnitude - 1.5) / (1.0 + 1.5 * magnitude);
  } else if (magnitude >= 0.6875) {
    table = 1;
    t = (magnitude - 1.0) / (magnitude + 1.0);
  } else if (magnitude >= 0.4375) {
    table = 0;
    t = (2.0 * magnitude - 1.0) / (2.0 + magnitude);
  }
  const double z = t * t;
  const double w = z * z;
  const double even = z * (a[0] + w * (a[2] + w * (a[4] + w * (a[6] + w * (a[8] + w * a[10])))));
  const double odd = w * (a[1] + w * (a[3] + w * (a[5] + w * (a[7] + w * a[9]))));
  if (table < 0) return t - t * (even + odd);
  const double result = high[table] - ((t * (even + odd) - low[table]) - t);
  return x < 0.0 ? -result : result;
}

double portable_atan2(double y, double x) {
  if (x != x || y != y) return x + y;
  const bool y_negative = __builtin_signbit(y) != 0;
  const bool x_negative = __builtin_signbit(x) != 0;
  double angle = 0.0;
  if (y == 0.0) {
    angle = x_negative ? pi : 0.0;
  } else if (x == 0.0 || (!is_finite(y) && is_finite(x))) {
    angle = half_pi;
  } else if (!is_finite(x)) {
    const double diagonal = is_finite(y) ? 0.0 : pi / 4.0;
    angle = x_negative ? pi - diagonal : diagonal;
  } else {
    angle = portable_atan(__builtin_fabs(y / x));
    if (x_negative) angle = pi - (angle - 2.0 * half_pi_low);
  }
  return y_negative ? -angle : angle;
}

// Returns (asin(s) - s) / s as a rational function of z = s^2.
double asin_ratio(double z) {
  const double p = z * (1.66666666666666657415e-01 +
                        z * (-3.25565818622400915405e-01 +
                             z * (2.01212532134862925881e-01 +
                                  z * (-4.00555345006794114027e-02 +
                                       z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05)))));
  const double q =
      1.0 + z * (-2.40339491173441421878e+00 +
                 z * (2.02094576023350569471e+00 + z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
  return p / q;
}

double portable_asin(double x) {
  const double magnitude = __builtin_fabs(x);
  if (!(magnitude <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  if (magnitude < 0.5) return x + x * asin_ratio(x * x);
  const double z = 0.5 * (1.0 - magnitude);
  const double s = sqrt_of(z);
  const double ratio = asin_ratio(z);
  const double result = half_pi - (2.0 * (s + s * ratio) - half_pi_low);
  // The root is start + rest; the square of start is exact.
  const auto start = std::bit_cast<double>(std::bit_cast<std::uint64_t>(s) & 0xfffffffff8000000u);
  const double rest = (z - start * start) / (s + start);
  const double error = ((half_pi - 2.0 * start) - result) - (2.0 * s * ratio + (2.0 * rest - half_pi_low));
  const double right = corrected(result, error, 1.8);  // the error is known to 0.2 units
  return x < 0.0 ? -right : right;
}

double portable_acos(double x) {
  const double magnitude = __builtin_fabs(x);
  if (!(magnitude <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  if (magnitude < 0.5) return half_pi - (x - (half_pi_low - x * asin_ratio(x * x)));
  const double z = 0.5 * (1.0 - magnitude);
  const double s = sqrt_of(z);
  const double angle = 2.0 * (s + s * asin_ratio(z));  // absolute value
  return x < 0.0 ? pi - (angle - 2.0 * half_pi_low) : angle;
}

constexpr double ln2_high = 6.93147180369123816490e-01;
constexpr double ln2_low = 1.90821492927058770002e-10;

double scale_by_power_of_two(double x, int exponent) {
  while (exponent > 1000) {
    x *= 0x1p1000;
    exponent -= 1000;
  }
  while (exponent < -1000) {
    x *= 0x1p-1000;
    exponent += 1000;
  }
  return x * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

double portable_exp(double x) {
  if (x != x) return x;
  if (x > 709.782712893383973096) return std::numeric_limits<double>::infinity();
  if (x < -745.13321910194110842) return 0.0;
  const double k = __builtin_rint(x * 1.44269504088896338700e+00);
  const double high = x - k * ln2_high;
  const double low = k * ln2_low;
  const double r = high - low;
  const double t = r * r;
  const double c =
      r -
      t * (1.66666666666666019037e-01 +
           t * (-2.77777777770155933842e-03 +
                t * (6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  const double result = 1.0 - ((low - (r * c) / (2.0 - c)) - high);
  return scale_by_power_of_two(result, static_cast<int>(k));
}

double portable_log(double x) {
  if (x != x || x == std::numeric_limits<double>::infinity()) return x;
  if (x == 0.0) return -std::numeric_limits<double>::infinity();
  if (x < 0.0) return std::numeric_limits<double>::quiet_NaN();
  int exponent = 0;
  if (x < 0x1p-1022) {  // subnormal
    x *= 0x1p54;
    exponent = -54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> 52) - 1023;
  auto mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
  if (mantissa > 1.41421356237309504880) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double f = mantissa - 1.0;
  const double k = exponent;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  return k * ln2_high - ((half_square - (s * (half_square + (even + odd)) + k * ln2_low)) - f);
}

}  // namespace

// The names of the C library. No function above calls them, so the compiler cannot turn these into recursive calls.
extern "C" {
double sin(double x) noexcept { return portable_sin(x); }
double cos(double x) noexcept { return portable_cos(x); }
void sincos(double x, double* sine, double* cosine) noexcept {
  *sine = portable_sin(x);
  *cosine = portable_cos(x);
}
double tan(double x) noexcept { return portable_tan(x); }
double atan(double x) noexcept { return portable_atan(x); }
double atan2(double y, double x) noexcept { return portable_atan2(y, x); }
double asin(double x) noexcept { return portable_asin(x); }
double acos(double x) noexcept { return portable_acos(x); }
double exp(double x) noexcept { return portable_exp(x); }
double log(double x) noexcept { return portable_log(x); }
double log2(double x) noexcept { return cohort::portable_log2(x); }
double log10(double x) noexcept { return cohort::portable_log10(x); }
double exp2(double x) noexcept { return cohort::portable_pow(2.0, x); }
double pow(double x, double y) noexcept { return cohort::portable_pow(x, y); }

float sinf(float x) noexcept { return static_cast<float>(portable_sin(x)); }
float cosf(float x) noexcept { return static_cast<float>(portable_cos(x)); }
void sincosf(float x, float* sine, float* cosine) noexcept {
  *sine = static_cast<float>(portable_sin(x));
  *cosine = static_cast<float>(portable_cos(x));
}
float tanf(float x) noexcept { return static_cast<float>(portable_tan(x)); }
float atanf(float x) noexcept { return static_cast<float>(portable_atan(x)); }
float atan2f(float y, float x) noexcept { return static_cast<float>(portable_atan2(y, x)); }
float asinf(float x) noexcept { return static_cast<float>(portable_asin(x)); }
float acosf(float x) noexcept { return static_cast<float>(portable_acos(x)); }
float expf(float x) noexcept { return static_cast<float>(portable_exp(x)); }
float logf(float x) noexcept { return static_cast<float>(portable_log(x)); }
float log2f(float x) noexcept { return static_cast<float>(cohort::portable_log2(x)); }
float log10f(float x) noexcept { return static_cast<float>(cohort::portable_log10(x)); }
float exp2f(float x) noexcept { return static_cast<float>(cohort::portable_pow(2.0, x)); }
float powf(float x, float y) noexcept { return static_cast<float>(cohort::portable_pow(x, y)); }

// The symbol that the linker must find (see CMakeLists.txt in this folder), so that it takes this object file before
// the C library.
extern const char cohort_portable_math = 1;
}
