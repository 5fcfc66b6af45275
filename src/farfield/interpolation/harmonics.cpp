#include "farfield/interpolation/harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace farfield::detail {

template <>
void evaluate_harmonics<2>(int degree, const double* t, double* values) {
  double re = 1, im = 0;
  values[0] = 1;
  for (int k = 1; k <= degree; ++k) {
    const double next = re * t[0] - im * t[1];
    im = re * t[1] + im * t[0];
    re = next;
    values[2 * k - 1] = re;
    values[2 * k] = im;
  }
}

// With z = t_3 and S_l = l! times the regular solid harmonic of degree l:
//   S_m^m = (t_1 + i t_2) / 2 S_{m-1}^{m-1}
//   (l^2 - m^2) S_l^m = (2l - 1) l z S_{l-1}^m - l (l - 1) r^2 S_{l-2}^m
template <>
void evaluate_harmonics<3>(int degree, const double* t, double* values) {
  const double squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  double re = 1, im = 0;  // of S_m^m
  for (int m = 0; m <= degree; ++m) {
    double two_down[2] = {}, one_down[2] = {re, im};
    values[place(m, m)] = re;
    if (m > 0) values[place(m, -m)] = im;
    for (int l = m + 1; l <= degree; ++l) {
      const double scale = 1.0 / (l * l - m * m), up = (2 * l - 1) * l * scale * t[2],
                   back = l * (l - 1) * scale * squared;
      for (int part = 0; part < (m > 0 ? 2 : 1); ++part) {
        const double value = up * one_down[part] - back * two_down[part];
        two_down[part] = one_down[part];
        one_down[part] = value;
        values[place(l, part == 0 ? m : -m)] = value;
      }
    }
    const double next = (re * t[0] - im * t[1]) / 2;
    im = (re * t[1] + im * t[0]) / 2;
    re = next;
  }
}

template <>
int degree_of<2>(std::size_t k) {
  return static_cast<int>((k + 1) / 2);
}

template <>
int degree_of<3>(std::size_t k) {
  int l = static_cast<int>(std::sqrt(static_cast<double>(k)));
  while (place(l, l) < k) ++l;
  while (l > 0 && place(l, -l) > k) --l;
  return l;
}

template <>
unsigned parity<2>(std::size_t k) {
  const unsigned degree = static_cast<unsigned>(degree_of<2>(k)), imaginary = k > 0 && k % 2 == 0 ? 1U : 0U;
  return ((degree + imaginary) & 1U) | imaginary << 1U;
}

template <>
unsigned parity<3>(std::size_t k) {
  const int l = degree_of<3>(k), m = static_cast<int>(k) - l * l - l;
  const unsigned sine = m < 0 ? 1U : 0U, order = static_cast<unsigned>(std::abs(m));
  return ((order + sine) & 1U) | sine << 1U | ((static_cast<unsigned>(l) - order) & 1U) << 2U;
}

// d/dt_1 z^k = k z^{k-1}, d/dt_2 z^k = i k z^{k-1}
template <>
void differentiate<2>(int degree, const double* coefficient, double* const* derivative) {
  const std::size_t count = functions<2>(degree);
  std::fill_n(derivative[0], count, 0.0);
  std::fill_n(derivative[1], count, 0.0);
  for (std::size_t k = 1; k <= static_cast<std::size_t>(degree); ++k) {
    const double re = coefficient[2 * k - 1] * static_cast<double>(k), im = coefficient[2 * k] * static_cast<double>(k);
    if (k == 1) {
      derivative[0][0] += re;
      derivative[1][0] += im;
    } else {
      derivative[0][2 * k - 3] += re;
      derivative[0][2 * k - 2] += im;
      derivative[1][2 * k - 2] -= re;
      derivative[1][2 * k - 3] += im;
    }
  }
}

//   d/dt_3 S_l^m = l S_{l-1}^m,   (d/dt_1 - i d/dt_2) S_l^m = l S_{l-1}^{m-1}
//   (d/dt_1 + i d/dt_2) S_l^m = -l S_{l-1}^{m+1}
template <>
void differentiate<3>(int degree, const double* coefficient, double* const* derivative) {
  for (int axis = 0; axis < 3; ++axis) std::fill_n(derivative[axis], functions<3>(degree), 0.0);
  const auto add = [&](int axis, int l, int m, double value) {
    if (std::abs(m) <= l) derivative[axis][place(l, m)] += value;
  };
  for (int l = 1; l <= degree; ++l) {
    const double axial = coefficient[place(l, 0)] * l;
    add(2, l - 1, 0, axial);
    add(0, l - 1, 1, -axial);
    add(1, l - 1, -1, -axial);
    for (int m = 1; m <= l; ++m) {
      const double cosine = coefficient[place(l, m)] * l, sine = coefficient[place(l, -m)] * l;
      add(2, l - 1, m, cosine);
      add(2, l - 1, -m, sine);
      add(0, l - 1, m - 1, cosine / 2);
      add(0, l - 1, m + 1, -cosine / 2);
      add(1, l - 1, m - 1, sine / 2);
      add(1, l - 1, m + 1, sine / 2);
      if (m > 1) {  // the sine of order 0 is 0
        add(0, l - 1, -(m - 1), sine / 2);
        add(1, l - 1, -(m - 1), -cosine / 2);
      }
      add(0, l - 1, -(m + 1), -sine / 2);
      add(1, l - 1, -(m + 1), -cosine / 2);
    }
  }
}

}  // namespace farfield::detail
