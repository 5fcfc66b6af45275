#include "farfield/images/rest.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/parallel.hpp"
#include "farfield/interpolation/harmonics.hpp"

namespace farfield::detail {
namespace {

using Complex = std::complex<double>;
constexpr std::size_t piece = 512;  // points

/// Function (l, m) of the harmonics as one complex number: its cosine and its sine.
template <int d>
Complex complex_part(const std::vector<double>& values, int l, int m) {
  if constexpr (d == 2) {
    const std::size_t k = static_cast<std::size_t>(l);
    return l == 0 ? Complex(values[0]) : Complex(values[2 * k - 1], values[2 * k]);
  } else {
    const int order = std::abs(m);
    const Complex value(values[place(l, order)], order > 0 ? values[place(l, -order)] : 0);
    return m >= 0 ? value : (order % 2 == 1 ? -1.0 : 1.0) * std::conj(value);
  }
}

std::vector<std::vector<double>> binomials(int degree) {
  std::vector<std::vector<double>> rows{{1}};
  for (int l = 1; l <= degree; ++l) {
    std::vector<double> row{1};
    for (std::size_t k = 1; k < rows.back().size(); ++k) row.push_back(rows.back()[k - 1] + rows.back()[k]);
    row.push_back(1);
    rows.push_back(std::move(row));
  }
  return rows;
}

// The addition theorem, in the plane z^l with m = m' = 0 in place of S:
//   S_l^m(x + t) = sum_l' binomial(l, l') sum_m' S_l'^m'(x) S_(l-l')^(m-m')(t),   S_l^-m = (-1)^m conj(S_l^m)
// polynomial: of even functions alone, so of cosines. turned: moments of t. Adds coefficients of the harmonics of x.
template <int d>
void translate(int degree, const std::vector<double>& polynomial, const std::vector<double>& turned,
               const std::vector<std::vector<double>>& binomial, std::vector<double>& coefficients) {
  const auto add = [&](int l, int m, Complex factor) {  // Re(factor S_l^m)
    if (m < 0) factor = (m % 2 != 0 ? -1.0 : 1.0) * std::conj(factor);
    const int order = std::abs(m);
    const std::size_t cosine = d == 2 ? static_cast<std::size_t>(std::max(0, 2 * l - 1)) : place(l, order);
    coefficients[cosine] += factor.real();
    if (d == 2 && l > 0) coefficients[static_cast<std::size_t>(2 * l)] -= factor.imag();
    if (d == 3 && order > 0) coefficients[place(l, -order)] -= factor.imag();
  };
  for (int l = 0; l <= degree; l += 2)
    for (int m = 0; m <= (d == 3 ? l : 0); m += 2) {
      const double c = d == 3 ? polynomial[place(l, m)] : polynomial[static_cast<std::size_t>(std::max(0, 2 * l - 1))];
      for (int k = 0; k <= l; ++k) {
        const double factor = c * binomial[static_cast<std::size_t>(l)][static_cast<std::size_t>(k)];
        if (d == 2) {
          add(k, 0, factor * complex_part<d>(turned, l - k, 0));
          continue;
        }
        for (int n = std::max(-k, m - (l - k)); n <= std::min(k, m + (l - k)); ++n)
          add(k, n, factor * complex_part<d>(turned, l - k, m - n));
      }
    }
}

}  // namespace

template <int d>
struct Rest<d>::Sums {
  std::vector<double> harmonic;    // sum of q h_k(v), v the source from the centre, scaled
  double charge = 0, squares = 0;  // sum of q, and of q |v|^2, in the caller's units
  std::array<double, 3> dipole{};  // sum of q v

  explicit Sums(std::size_t functions) : harmonic(functions) {}
  void add(const Sums& other) {
    for (std::size_t k = 0; k < harmonic.size(); ++k) harmonic[k] += other.harmonic[k];
    charge += other.charge;
    squares += other.squares;
    for (std::size_t l = 0; l < d; ++l) dipole[l] += other.dipole[l];
  }
};

template <int d>
typename Rest<d>::Sums Rest<d>::moments(const Points<d>& sources, const Eigen::Ref<const Eigen::VectorXd>& charges,
                                        int threads) const {
  const std::size_t count = static_cast<std::size_t>(sources.cols()), pieces = (count + piece - 1) / piece,
                    size = functions<d>(shape_->degree());
  std::vector<Sums> parts(pieces, Sums(0));
  gaussdrift::base::parallel_for(
      {pieces, 4e-9 * static_cast<double>(count * size)}, threads, [&] { return std::vector<double>(size); },
      [&](std::vector<double>& values, std::size_t p) {
        Sums& sums = parts[p] = Sums(size);
        for (std::size_t j = p * piece; j < std::min(count, (p + 1) * piece); ++j) {
          const auto index = static_cast<Eigen::Index>(j);
          const double q = charges.data()[j];
          double t[3] = {}, squared = 0;
          for (std::size_t l = 0; l < d; ++l) {
            const double v = sources(static_cast<Eigen::Index>(l), index) - copies_.axes()[l].centre;
            t[l] = v * shape_->scale();
            squared += v * v;
            sums.dipole[l] += q * v;
          }
          sums.charge += q;
          sums.squares += q * squared;
          evaluate_harmonics<d>(shape_->degree(), t, values.data());
          for (std::size_t k = 0; k < size; ++k) sums.harmonic[k] += q * values[k];
        }
      });
  Sums all(size);
  for (const Sums& part : parts) all.add(part);
  return all;
}

/// Coefficients of the potential at a target, from its centre and scaled.
template <int d>
std::vector<double> Rest<d>::local(const std::vector<double>& moments) const {
  const int degree = shape_->degree();
  const std::vector<std::vector<double>> binomial = binomials(degree);
  std::vector<double> coefficients(moments.size()), turned(moments.size());
  for (std::size_t i = 0; i < copies_.turned().size(); ++i) {
    const Copy& copy = copies_.turned()[i];
    // x - s y: every axis that is not mirrored turns its sign.
    unsigned signs = 0;
    for (unsigned l = 0; l < d; ++l) signs |= static_cast<unsigned>(copy.sign[l] > 0) << l;
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const unsigned odd = parity<d>(k) & signs;
      const bool turns = ((odd ^ odd >> 1U ^ odd >> 2U) & 1U) != 0;
      turned[k] = (turns ? -copy.charge : copy.charge) * moments[k];
    }
    translate<d>(degree, shape_->polynomials()[i], turned, binomial, coefficients);
  }
  return coefficients;
}

template <int d>
void Rest<d>::add(const Points<d>& sources, const Eigen::Ref<const Eigen::VectorXd>& charges, const Points<d>& targets,
                  int threads, Eigen::VectorXd* potential, Points<d>& field) const {
  const Sums sums = moments(sources, charges, threads);
  const std::vector<double> coefficients = local(sums.harmonic);
  const std::size_t size = coefficients.size(), count = static_cast<std::size_t>(targets.cols());
  std::array<std::vector<double>, 3> slopes;
  double* derivative[3] = {};
  for (std::size_t l = 0; l < d; ++l) {
    slopes[l].resize(size);
    derivative[l] = slopes[l].data();
  }
  differentiate<d>(shape_->degree(), coefficients.data(), derivative);
  // The background: b |x - s y|^2, b = Laplacian / 2d, for all turns.
  const double b = shape_->laplacian() / (2 * d);
  double charge = 0;
  std::array<double, 3> turned{};
  for (const Copy& copy : copies_.turned()) {
    charge += copy.charge;
    for (std::size_t l = 0; l < d; ++l) turned[l] += copy.charge * copy.sign[l];
  }
  gaussdrift::base::parallel_for(
      {(count + piece - 1) / piece, 8e-9 * static_cast<double>(count * size)}, threads,
      [&] { return std::vector<double>(size); },
      [&](std::vector<double>& values, std::size_t p) {
        for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
          const auto index = static_cast<Eigen::Index>(i);
          double t[3] = {}, u[3] = {}, value = b * charge * sums.squares;
          for (std::size_t l = 0; l < d; ++l) {
            u[l] = targets(static_cast<Eigen::Index>(l), index) - copies_.axes()[l].centre;
            t[l] = u[l] * shape_->scale();
            value += b * u[l] * (charge * sums.charge * u[l] - 2 * turned[l] * sums.dipole[l]);
          }
          evaluate_harmonics<d>(shape_->degree(), t, values.data());
          for (std::size_t l = 0; l < d; ++l) {
            double slope = 0;
            for (std::size_t k = 0; k < size; ++k) slope += slopes[l][k] * values[k];
            field(static_cast<Eigen::Index>(l), index) -=
                slope * shape_->scale() + 2 * b * (charge * sums.charge * u[l] - turned[l] * sums.dipole[l]);
          }
          if (!potential) continue;
          for (std::size_t k = 0; k < size; ++k) value += coefficients[k] * values[k];
          (*potential)[index] += value;
        }
      });
}

template class Rest<2>;
template class Rest<3>;

}  // namespace farfield::detail
