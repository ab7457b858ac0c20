// Four doubles side by side: a number type for laws that are evaluated at four points at a time.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace dovetail::fem {

#define DOVETAIL_ALWAYS_INLINE [[gnu::always_inline]] inline

/// Arithmetic and functions act on each lane; a double stands for four equal ones.
struct Four {
  using Register [[gnu::vector_size(32)]] = double;
  using Bits [[gnu::vector_size(32)]] = std::int64_t;
  Register v;

  Four() = default;
  DOVETAIL_ALWAYS_INLINE Four(double x) : v{x, x, x, x} {}
  DOVETAIL_ALWAYS_INLINE explicit Four(const Register& r) : v(r) {}

  DOVETAIL_ALWAYS_INLINE static Four load(const double* p) {
    Four x;
    std::memcpy(&x.v, p, sizeof x.v);
    return x;
  }
  DOVETAIL_ALWAYS_INLINE void store(double* p) const { std::memcpy(p, &v, sizeof v); }

  DOVETAIL_ALWAYS_INLINE Four& operator+=(const Four& b) { return v += b.v, *this; }
  DOVETAIL_ALWAYS_INLINE Four& operator-=(const Four& b) { return v -= b.v, *this; }
  DOVETAIL_ALWAYS_INLINE Four& operator*=(const Four& b) { return v *= b.v, *this; }
  DOVETAIL_ALWAYS_INLINE Four& operator/=(const Four& b) { return v /= b.v, *this; }
  DOVETAIL_ALWAYS_INLINE friend Four operator+(Four a, const Four& b) { return a += b; }
  DOVETAIL_ALWAYS_INLINE friend Four operator-(Four a, const Four& b) { return a -= b; }
  DOVETAIL_ALWAYS_INLINE friend Four operator*(Four a, const Four& b) { return a *= b; }
  DOVETAIL_ALWAYS_INLINE friend Four operator/(Four a, const Four& b) { return a /= b; }
  DOVETAIL_ALWAYS_INLINE friend Four operator-(const Four& a) { return Four(-a.v); }
};

/// x > 0 ? a : b in each lane; NaN counts as not positive.
DOVETAIL_ALWAYS_INLINE Four wherePositive(const Four& x, const Four& a, const Four& b) {
  return Four(x.v > 0.0 ? a.v : b.v);
}
DOVETAIL_ALWAYS_INLINE double wherePositive(double x, double a, double b) { return x > 0.0 ? a : b; }

DOVETAIL_ALWAYS_INLINE Four sqrt(const Four& x) {
  Four root;
  for (int lane = 0; lane < 4; ++lane) root.v[lane] = __builtin_sqrt(x.v[lane]);
  return root;
}

namespace detail {

// Adding this to a double below 2^51 leaves the rounded integer in the low bits of the sum.
inline constexpr double integerShift = 6755399441055744.0;

DOVETAIL_ALWAYS_INLINE Four asDouble(const Four::Bits& bits) {
  Four x;
  std::memcpy(&x.v, &bits, sizeof bits);
  return x;
}
DOVETAIL_ALWAYS_INLINE Four::Bits asBits(const Four& x) {
  Four::Bits bits;
  std::memcpy(&bits, &x.v, sizeof bits);
  return bits;
}

}  // namespace detail

/// Natural logarithm of normal positive numbers, within one unit in the last place; NaN for x ≤ 0. The polynomial is
/// that of FreeBSD's msun, e_log.c.
DOVETAIL_ALWAYS_INLINE Four log(const Four& x) {
  using detail::asBits;
  using detail::asDouble;
  // x = 2^k (1 + f) with 1 + f between √½ and √2.
  const Four::Bits bits = asBits(x), rootHalf = asBits(Four(0.70710678118654752));
  const Four::Bits k = (bits - rootHalf) >> 52;
  const Four f = asDouble(bits - (k << 52)) - 1.0;
  const Four exponent = asDouble(k + asBits(Four(detail::integerShift))) - detail::integerShift;
  const Four s = f / (2.0 + f), z = s * s, w = z * z;
  const Four even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const Four odd = z * (6.666666666666735130e-01 +
                        w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const Four half = 0.5 * f * f;
  const Four low = s * (half + (even + odd)) + exponent * 1.90821492927058770002e-10;
  const Four result = exponent * 6.93147180369123816490e-01 - ((half - low) - f);
  return wherePositive(x, result, std::numeric_limits<double>::quiet_NaN());
}

/// eˣ for |x| < 700, within two units in the last place; beyond it the ends' values. The rational approximation is that
/// of FreeBSD's msun, e_exp.c.
DOVETAIL_ALWAYS_INLINE Four exp(Four x) {
  using detail::asBits;
  using detail::asDouble;
  x = wherePositive(x - 700.0, 700.0, x);
  x = wherePositive(-700.0 - x, -700.0, x);
  const Four shifted = x * 1.44269504088896338700 + detail::integerShift;
  const Four k = shifted - detail::integerShift;
  const Four high = x - k * 6.93147180369123816490e-01, low = k * 1.90821492927058770002e-10;
  const Four r = high - low, t = r * r;
  const Four c =
      r -
      t * (1.66666666666666019037e-01 +
           t * (-2.77777777770155933842e-03 +
                t * (6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  const Four y = 1.0 - ((low - (r * c) / (2.0 - c)) - high);
  return asDouble(asBits(y) + (asBits(shifted) << 52));
}

/// x^p for x > 0.
DOVETAIL_ALWAYS_INLINE Four pow(const Four& x, double p) { return exp(p * log(x)); }

}  // namespace dovetail::fem
