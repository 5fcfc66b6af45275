// The velocities of the named fields, as operations on Packs; each named field's own file says what they mean. A formula has
//   axes           the first axes of a point, which it changes
//   time_values    how many numbers it takes of t: ByFormula::at_time() computes them
//   cheap          a step is short enough to advance several Packs side by side
// and is made from its parameters. See core/simd/pack.hpp for who may include this.
#pragma once

#include "rows/pack_functions.hpp"

namespace gaussdrift::named::CORE_ISA {
namespace {

using namespace rows::CORE_ISA;

constexpr double pi = 3.14159265358979323846;

// center, rate
struct Rotation {
  static constexpr int axes = 2, time_values = 0;
  static constexpr bool cheap = true;
  double cx, cy, rate;
  explicit Rotation(const double* p) : cx(p[0]), cy(p[1]), rate(p[2]) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[2], Pack (&u)[2]) const {
    u[0] = -(rate * (x[1] - cy));
    u[1] = rate * (x[0] - cx);
  }
};

// velocity
template <int d>
struct Translation {
  static constexpr int axes = d, time_values = 0;
  static constexpr bool cheap = true;
  const double* wind;
  explicit Translation(const double* p) : wind(p) {}
  CORE_INLINE void velocity(const double*, const Pack (&)[d], Pack (&u)[d]) const {
    for (int k = 0; k < d; ++k) u[k] = broadcast(wind[k]);
  }
};

// y of the layer at rest, rate
struct Shear {
  static constexpr int axes = 2, time_values = 0;
  static constexpr bool cheap = true;
  double middle, rate;
  explicit Shear(const double* p) : middle(p[0]), rate(p[1]) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[2], Pack (&u)[2]) const {
    u[0] = rate * (x[1] - middle);
    u[1] = Pack{};
  }
};

// center (3 numbers), rates (3)
template <int d>
struct Strain {
  static constexpr int axes = d, time_values = 0;
  static constexpr bool cheap = true;
  const double *center, *rates;
  explicit Strain(const double* p) : center(p), rates(p + 3) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[d], Pack (&u)[d]) const {
    for (int k = 0; k < d; ++k) u[k] = rates[k] * (x[k] - center[k]);
  }
};

// A box: lower corner (3 numbers), lengths (3). unit() is 0 ... 1 across it.
struct Scaled {
  const double *min, *length;
  explicit Scaled(const double* p) : min(p), length(p + 3) {}
  CORE_INLINE Pack unit(int axis, Pack x) const { return (x - min[axis]) / length[axis]; }
};

// box; of time: 2 cos(pi t / T)
struct Swirl : Scaled {
  static constexpr int axes = 2, time_values = 1;
  static constexpr bool cheap = false;
  using Scaled::Scaled;
  CORE_INLINE void velocity(const double* of_time, const Pack (&x)[2], Pack (&u)[2]) const {
    const double g = of_time[0];
    Pack sa, ca, sb, cb;
    sine_and_cosine(pi * unit(0, x[0]), sa, ca);
    sine_and_cosine(pi * unit(1, x[1]), sb, cb);
    u[0] = length[0] * g * (sa * sa) * (sb * cb);
    u[1] = -(length[1] * g * (sb * sb) * (sa * ca));
  }
};

// box, amplitude; of time: a, 1 - 2 a
struct DoubleGyre : Scaled {
  static constexpr int axes = 2, time_values = 2;
  static constexpr bool cheap = false;
  double amplitude;
  explicit DoubleGyre(const double* p) : Scaled(p), amplitude(p[6]) {}
  CORE_INLINE void velocity(const double* of_time, const Pack (&x)[2], Pack (&u)[2]) const {
    const double a = of_time[0], b = of_time[1];
    const Pack xi = 2 * unit(0, x[0]), eta = unit(1, x[1]);
    const Pack f = (a * xi + b) * xi, slope = 2 * a * xi + b;
    Pack sf, cf, se, ce;
    sine_and_cosine(pi * f, sf, cf);
    sine_and_cosine(pi * eta, se, ce);
    u[0] = -(length[0] / 2 * pi * amplitude * sf * ce);
    u[1] = length[1] * pi * amplitude * cf * se * slope;
  }
};

// corner (2 numbers), wave number; of time: speed
struct TaylorGreen {
  static constexpr int axes = 2, time_values = 1;
  static constexpr bool cheap = false;
  double x0, y0, wave;
  explicit TaylorGreen(const double* p) : x0(p[0]), y0(p[1]), wave(p[2]) {}
  CORE_INLINE void velocity(const double* of_time, const Pack (&x)[2], Pack (&u)[2]) const {
    Pack sa, ca, sb, cb;
    sine_and_cosine(wave * (x[0] - x0), sa, ca);
    sine_and_cosine(wave * (x[1] - y0), sb, cb);
    u[0] = of_time[0] * sa * cb;
    u[1] = -(of_time[0] * ca * sb);
  }
};

/// Circles: u = omega(r^2) (-(y - c_y), x - c_x). First of the parameters is center (2 numbers), then those of Omega.
template <class Omega>
struct Circular {
  static constexpr int axes = 2, time_values = 0;
  static constexpr bool cheap = false;
  double cx, cy;
  Omega omega;
  explicit Circular(const double* p) : cx(p[0]), cy(p[1]), omega(p + 2) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[2], Pack (&u)[2]) const {
    const Pack dx = x[0] - cx, dy = x[1] - cy, turn = omega(dx * dx + dy * dy);
    u[0] = -(turn * dy);
    u[1] = turn * dx;
  }
};

// radius, strongest angular velocity times 3 sqrt(3) / 2
struct DoswellOmega {
  double radius, most;
  explicit DoswellOmega(const double* p) : radius(p[0]), most(p[1]) {}
  CORE_INLINE Pack operator()(Pack square) const {
    const Pack s = root(square) / radius, cosine = cosh(s);
    Pack ratio = tanh(s) / s;
    ratio = s == 0.0 ? broadcast(1.0) : ratio;
    return most * ratio / (cosine * cosine);
  }
};

/// (1 - exp(-s)) / s for s >= 0, 1 at s = 0.
CORE_INLINE Pack gaussian_swirl(Pack s) {
  const Pack ratio = -expm1(-s) / s;
  return s == 0.0 ? broadcast(1.0) : ratio;
}

// square of the radius of the core, angular velocity at the centre
struct LambOseenOmega {
  double core, most;
  explicit LambOseenOmega(const double* p) : core(p[0]), most(p[1]) {}
  CORE_INLINE Pack operator()(Pack square) const { return most * gaussian_swirl(square / core); }
};

// box; of time: cos(pi t / T)
struct Deformation : Scaled {
  static constexpr int axes = 3, time_values = 1;
  static constexpr bool cheap = false;
  using Scaled::Scaled;
  CORE_INLINE void velocity(const double* of_time, const Pack (&x)[3], Pack (&u)[3]) const {
    const double g = of_time[0];
    Pack square[3], twice[3];  // sin^2(pi xi), sin(2 pi xi)
    for (int k = 0; k < 3; ++k) {
      Pack s, c;
      sine_and_cosine(pi * unit(k, x[k]), s, c);
      square[k] = s * s;
      twice[k] = 2 * s * c;
    }
    u[0] = 2 * length[0] * g * square[0] * twice[1] * twice[2];
    u[1] = -(length[1] * g * twice[0] * square[1] * twice[2]);
    u[2] = -(length[2] * g * twice[0] * twice[1] * square[2]);
  }
};

// A, B, C, wave number
struct Abc {
  static constexpr int axes = 3, time_values = 0;
  static constexpr bool cheap = false;
  double a, b, c, wave;
  explicit Abc(const double* p) : a(p[0]), b(p[1]), c(p[2]), wave(p[3]) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[3], Pack (&u)[3]) const {
    Pack sine[3], cosine[3];
    for (int k = 0; k < 3; ++k) sine_and_cosine(wave * x[k], sine[k], cosine[k]);
    u[0] = a * sine[2] + c * cosine[1];
    u[1] = b * sine[0] + a * cosine[2];
    u[2] = c * sine[1] + b * cosine[0];
  }
};

// center (3 numbers), strain, strain / (4 viscosity), angular velocity at the centre
struct Burgers {
  static constexpr int axes = 3, time_values = 0;
  static constexpr bool cheap = false;
  const double* center;
  double strain, quarter, most;
  explicit Burgers(const double* p) : center(p), strain(p[3]), quarter(p[4]), most(p[5]) {}
  CORE_INLINE void velocity(const double*, const Pack (&x)[3], Pack (&u)[3]) const {
    const Pack dx = x[0] - center[0], dy = x[1] - center[1];
    const Pack omega = most * gaussian_swirl(quarter * (dx * dx + dy * dy));
    u[0] = -(strain / 2 * dx + omega * dy);
    u[1] = omega * dx - strain / 2 * dy;
    u[2] = strain * (x[2] - center[2]);
  }
};

}  // namespace
}  // namespace gaussdrift::named::CORE_ISA
