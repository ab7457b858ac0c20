// Four doubles side by side: a number type for laws that are evaluated at four points at a time.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace dovetail::fem {

#define DOVETAIL_ALWAYS_INLINE [[gnu::always_inline]] inline

/// Arithmetic and functions act on each lane; a double stands for four equal ones. In memory it is an array, so that
/// how functions hand it over does not depend on the processor that a program is compiled for.
struct alignas(32) Four {
  using Register [[gnu::vector_size(32)]] = double;
  using Bits [[gnu::vector_size(32)]] = std::uint64_t;
  using Integers [[gnu::vector_size(32)]] = std::int64_t;
  double v[4];

  Four() = default;
  DOVETAIL_ALWAYS_INLINE Four(double x) : v{x, x, x, x} {}
  DOVETAIL_ALWAYS_INLINE explicit Four(const Register& r) { std::memcpy(v, &r, sizeof v); }
  DOVETAIL_ALWAYS_INLINE explicit Four(const Bits& b) { std::memcpy(v, &b, sizeof v); }

  DOVETAIL_ALWAYS_INLINE static Four load(const double* p) {
    Four x;
    std::memcpy(x.v, p, sizeof x.v);
    return x;
  }
  DOVETAIL_ALWAYS_INLINE void store(double* p) const { std::memcpy(p, v, sizeof v); }

  DOVETAIL_ALWAYS_INLINE Four& operator+=(const Four& b) { return *this = *this + b; }
  DOVETAIL_ALWAYS_INLINE Four& operator-=(const Four& b) { return *this = *this - b; }
  DOVETAIL_ALWAYS_INLINE Four& operator*=(const Four& b) { return *this = *this * b; }
  DOVETAIL_ALWAYS_INLINE Four& operator/=(const Four& b) { return *this = *this / b; }
  DOVETAIL_ALWAYS_INLINE friend Four operator+(const Four& a, const Four& b) { return Four(In(a).r + In(b).r); }
  DOVETAIL_ALWAYS_INLINE friend Four operator-(const Four& a, const Four& b) { return Four(In(a).r - In(b).r); }
  DOVETAIL_ALWAYS_INLINE friend Four operator*(const Four& a, const Four& b) { return Four(In(a).r * In(b).r); }
  DOVETAIL_ALWAYS_INLINE friend Four operator/(const Four& a, const Four& b) { return Four(In(a).r / In(b).r); }
  DOVETAIL_ALWAYS_INLINE friend Four operator-(const Four& a) { return Four(-In(a).r); }

  /// The lanes in a register, within one expression.
  struct In {
    Register r;
    DOVETAIL_ALWAYS_INLINE explicit In(const Four& x) { std::memcpy(&r, x.v, sizeof r); }
  };
  struct BitsIn {
    Bits b;
    DOVETAIL_ALWAYS_INLINE explicit BitsIn(const Four& x) { std::memcpy(&b, x.v, sizeof b); }
  };
};

/// x > 0 ? a : b in each lane; NaN counts as not positive.
DOVETAIL_ALWAYS_INLINE Four wherePositive(const Four& x, const Four& a, const Four& b) {
  return Four(Four::In(x).r > 0.0 ? Four::In(a).r : Four::In(b).r);
}
DOVETAIL_ALWAYS_INLINE double wherePositive(double x, double a, double b) { return x > 0.0 ? a : b; }

DOVETAIL_ALWAYS_INLINE Four sqrt(const Four& x) {
  Four::In root(x);
  for (int lane = 0; lane < 4; ++lane) root.r[lane] = __builtin_sqrt(root.r[lane]);
  return Four(root.r);
}

namespace detail {
// Adding this to a double below 2^51 leaves the rounded integer in the low bits of the sum.
inline constexpr double integerShift = 6755399441055744.0;
}  // namespace detail

/// Natural logarithm of normal positive numbers, within one unit in the last place; NaN for x ≤ 0. The polynomial is
/// that of FreeBSD's msun, e_log.c.
DOVETAIL_ALWAYS_INLINE Four log(const Four& x) {
  using BitsIn = Four::BitsIn;
  // x = 2^k (1 + f) with 1 + f between √½ and √2.
  const BitsIn bits(x), rootHalf(Four(0.70710678118654752)), shift{Four(detail::integerShift)};
  const Four::Bits k = reinterpret_cast<Four::Bits>(reinterpret_cast<Four::Integers>(bits.b - rootHalf.b) >> 52);
  const Four f = Four(bits.b - (k << 52)) - 1.0;
  const Four exponent = Four(k + shift.b) - detail::integerShift;
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
DOVETAIL_ALWAYS_INLINE Four exp(const Four& exponent) {
  Four x = wherePositive(exponent - 700.0, 700.0, exponent);
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
  return Four(Four::BitsIn(y).b + (Four::BitsIn(shifted).b << 52));
}

/// x^p for x > 0.
DOVETAIL_ALWAYS_INLINE Four pow(const Four& x, double p) { return exp(p * log(x)); }

}  // namespace dovetail::fem
