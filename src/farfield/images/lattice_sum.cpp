#include "farfield/images/lattice_sum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

namespace farfield::detail {
namespace {

using std::numbers::pi;

constexpr double negligible = 6.2;  // exp(-x^2) beyond it is below 2e-17
/// 1 takes as many of the one as of the other. An image takes some 20 times as long as a wave; 2 to 2.5 are as good.
constexpr double waves_for_images = 2.2;

/// The radial part of a potential and derivative / r.
struct Radial {
  double value = 0, slope = 0;
};

/// Images one by one, in 3D: erfc(a r)/r, or what is left of it without 1/r, which is smooth.
template <int d>
Radial short_range(double squared, double a, bool near);

template <>
Radial short_range<3>(double squared, double a, bool near) {
  const double r = std::sqrt(squared), s = a * r, bell = 2 * a / std::sqrt(pi) * std::exp(-s * s);
  if (!near) return {std::erfc(s) / r, -(std::erfc(s) / r + bell) / squared};
  if (s > 0.5) return {-std::erf(s) / r, (std::erf(s) / r - bell) / squared};
  // erf(s)/s = 2/sqrt(pi) sum_k (-s^2)^k / (k! (2k + 1))
  double value = 0, slope = 0, power = 1;  // power: (-1)^k s^(2k) / k!
  for (int k = 0; k < 16; ++k) {
    value += power / (2 * k + 1);
    slope -= power * 2 / (2 * k + 3);  // by s, over s: the term after it
    power *= -s * s / (k + 1);
  }
  const double factor = -2 * a / std::sqrt(pi);
  return {factor * value, factor * a * a * slope};
}

/// In 2D: E_1(a^2 r^2) / 2, or what is left of it without -ln r.
template <>
Radial short_range<2>(double squared, double a, bool near) {
  const double s = a * a * squared;
  if (!near) return {-std::expint(-s) / 2, -std::exp(-s) / squared};
  // E_1(s) + ln s = Ein(s) - gamma,  Ein(s) = sum_k (-1)^(k+1) s^k / (k k!)
  double whole = 0, slope = 1;  // slope: (1 - exp(-s)) / s
  if (s < 1) {
    double power = 1;  // (-1)^(k+1) s^(k-1) / (k-1)!
    slope = 0;
    for (int k = 1; k < 22; ++k) {
      whole += power * s / (static_cast<double>(k) * k);
      slope += power / k;
      power *= -s / k;
    }
  } else {
    whole = -std::expint(-s) + std::log(s) + std::numbers::egamma;
    slope = -std::expm1(-s) / s;
  }
  return {(whole - std::numbers::egamma) / 2 - std::log(a), a * a * slope};
}

}  // namespace

template <int d>
LatticeSum<d>::LatticeSum(const std::array<CopiedAxis, 3>& axes, const Copy& turned) : axes_(axes) {
  int repeated = 0;
  for (std::size_t l = 0; l < d; ++l) {
    if (!axes[l].repeats()) continue;
    ++repeated;
    strip_ = static_cast<int>(l);
    odd_[l] = turned.sign[l] < 0;
    volume_ *= axes[l].period();
  }
  if (repeated < d) return;
  strip_ = -1;
  split_ = waves_for_images * std::sqrt(pi) / std::pow(volume_, 1.0 / d);
  laplacian_ = 2 * pi * (d - 1) / volume_;
  make_waves();
}

template <int d>
int LatticeSum<d>::first(std::size_t l, int most) const {
  const bool wrong = axes_[l].ends == Ends::mirrors && (most % 2 != 0) != odd_[l];
  return -most - (wrong ? 1 : 0);
}

template <int d>
Smooth LatticeSum<d>::at(const double* z) const {
  if (d == 2 && strip_ >= 0) return in_strip(z);
  Smooth sum;
  add_images(z, sum);
  add_waves(z, sum);
  sum.value -= pi / (split_ * split_) / volume_ * (d == 3 ? 1.0 : 0.5);
  return sum;
}

template <int d>
void LatticeSum<d>::add_images(const double* z, Smooth& sum) const {
  std::array<int, 3> most{}, begin{}, steps{1, 1, 1};
  const double reach = negligible / split_;
  for (std::size_t l = 0; l < d; ++l) {
    most[l] = std::max(axes_[l].near, static_cast<int>(std::ceil((reach + std::abs(z[l])) / axes_[l].length)));
    begin[l] = first(l, most[l]);
    steps[l] = step(l);
  }
  double distance[3] = {};
  for (int i = begin[0]; i <= most[0]; i += steps[0])
    for (int j = begin[1]; j <= most[1]; j += steps[1])
      for (int k = begin[2]; k <= most[2]; k += steps[2]) {
        const int m[3] = {i, j, k};
        double squared = 0;
        bool near = true;
        for (std::size_t l = 0; l < d; ++l) {
          distance[l] = z[l] - m[l] * axes_[l].length;
          squared += distance[l] * distance[l];
          near = near && std::abs(m[l]) <= axes_[l].near;
        }
        if (!near && squared > reach * reach) continue;
        const Radial term = short_range<d>(squared, split_, near);
        sum.value += term.value;
        for (std::size_t l = 0; l < d; ++l) sum.gradient[l] += term.slope * distance[l];
      }
}

/// (2 or 4) pi / V sum_k exp(-k^2 / 4 a^2) / k^2 cos(k z). Images at odd lengths turn the sign of every second wave.
template <int d>
void LatticeSum<d>::make_waves() {
  const double highest = 2 * negligible * split_;
  for (std::size_t l = 0; l < d; ++l) most_waves_[l] = static_cast<int>(highest * axes_[l].period() / (2 * pi));
  for (int i = 0; i <= most_waves_[0]; ++i)
    for (int j = 0; j <= most_waves_[1]; ++j)
      for (int k = 0; k <= most_waves_[2]; ++k) {
        Wave wave{{i, j, k}, laplacian_};
        double squared = 0;
        for (std::size_t l = 0; l < d; ++l) {
          squared += std::pow(2 * pi / axes_[l].period() * wave.number[l], 2);
          if (wave.number[l] > 0) wave.strength *= 2;  // and its opposite
          if (odd_[l] && wave.number[l] % 2 == 1) wave.strength = -wave.strength;
        }
        if (squared == 0 || squared > highest * highest) continue;
        wave.strength *= std::exp(-squared / (4 * split_ * split_)) / squared;
        waves_.push_back(wave);
      }
}

template <int d>
void LatticeSum<d>::add_waves(const double* z, Smooth& sum) const {
  std::array<std::vector<std::complex<double>>, 3> powers;  // exp(i k_l z_l)
  for (std::size_t l = 0; l < 3; ++l) {
    powers[l] = {1};
    if (l >= d) continue;
    const double phase = 2 * pi / axes_[l].period() * z[l];
    for (int k = 1; k <= most_waves_[l]; ++k) powers[l].emplace_back(std::cos(k * phase), std::sin(k * phase));
  }
  for (const Wave& wave : waves_) {
    std::complex<double> factor[3];
    for (std::size_t l = 0; l < 3; ++l) factor[l] = powers[l][static_cast<std::size_t>(wave.number[l])];
    sum.value += wave.strength * factor[0].real() * factor[1].real() * factor[2].real();
    for (std::size_t l = 0; l < d; ++l)
      sum.gradient[l] -= wave.strength * 2 * pi / axes_[l].period() * wave.number[l] * factor[l].imag() *
                         factor[(l + 1) % 3].real() * factor[(l + 2) % 3].real();
  }
}

/// ln |2 sin(pi w / P)| and its derivative (pi / P) cot(pi w / P), less those of the near images, ln |w - w_m|. The nearest
/// image is one of them: it is taken out before anything becomes large.
template <int d>
Smooth LatticeSum<d>::in_strip(const double* z) const {
  using Complex = std::complex<double>;
  const std::size_t along = static_cast<std::size_t>(strip_), across = 1 - along;
  const CopiedAxis& axis = axes_[along];
  const double period = axis.period();
  const int most = axis.near;
  int nearest = first(along, most);
  for (int m = nearest; m <= most; m += step(along))
    if (std::abs(z[along] - m * axis.length) < std::abs(z[along] - nearest * axis.length)) nearest = m;
  const Complex w(z[along], z[across]), v = w - nearest * axis.length, x = pi / period * v;
  double value = 0;
  Complex slope = 0;
  if (std::abs(x) < 0.1) {
    // sin x / x and cot x - 1 / x
    const Complex s = x * x;
    value =
        std::log(2 * pi / period) +
        std::log(std::abs(1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0))))));
    slope = -pi / period * x * (1.0 / 3 + s * (1.0 / 45 + s * (2.0 / 945 + s * (1.0 / 4725 + s * (2.0 / 93555)))));
  } else {
    // With the decaying exponential: sin x = +-i/2 exp(-+i x) (1 - exp(+-2 i x)).
    const Complex up = x.imag() >= 0 ? Complex(0, 1) : Complex(0, -1), small = std::exp(2.0 * up * x);
    value = std::abs(x.imag()) + std::log(std::abs(1.0 - small)) - std::log(std::abs(v));
    slope = pi / period * -up * (1.0 + small) / (1.0 - small) - 1.0 / v;
  }
  for (int m = first(along, most); m <= most; m += step(along)) {
    if (m == nearest || m < -most) continue;
    const Complex distance = w - m * axis.length;
    value -= std::log(std::abs(distance));
    slope -= 1.0 / distance;
  }
  Smooth sum{.value = -value};
  sum.gradient[along] = -slope.real();
  sum.gradient[across] = slope.imag();
  return sum;
}

template class LatticeSum<2>;
template class LatticeSum<3>;

}  // namespace farfield::detail
