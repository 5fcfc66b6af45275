#include "reproduce/bases_of_cube.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace gaussdrift::reproduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Places = Eigen::Matrix3Xd;

Places random_places(Index count, unsigned seed, double shift) {
  std::mt19937 random(seed);
  Places places(3, count);
  for (double& x : places.reshaped()) x = static_cast<double>(random()) * 0x1p-32 - 0.5;
  places.row(0).array() += shift;
  return places;
}

/// [i][j]: 1/|x_i - y_j|
MatrixXd potentials(const Places& x, const Places& y) {
  MatrixXd values(x.cols(), y.cols());
  for (Index i = 0; i < x.cols(); ++i)
    for (Index j = 0; j < y.cols(); ++j) values(i, j) = 1 / (x.col(i) - y.col(j)).norm();
  return values;
}

/// Tensor products of `along` in [-1/2, 1/2].
Places tensor(const std::vector<double>& along) {
  const auto count = static_cast<Index>(along.size());
  Places places(3, count * count * count);
  Index at = 0;
  for (const double x : along)
    for (const double y : along)
      for (const double z : along) places.col(at++) << x, y, z;
  return places;
}

std::vector<double> chebyshev_points(int count) {
  std::vector<double> points;
  for (int i = 0; i < count; ++i) points.push_back(-0.5 * std::cos(std::numbers::pi * (2 * i + 1) / (2 * count)));
  return points;
}

/// Chebyshev polynomials of 2x by degree.
std::vector<double> chebyshev(double x, int degree) {
  std::vector<double> values{1, 2 * x};
  for (int a = 2; a <= degree; ++a) values.push_back(4 * x * values.back() - values[values.size() - 2]);
  values.resize(static_cast<std::size_t>(degree) + 1);
  return values;
}

/// [point][product of Chebyshev polynomials], all or those of a total degree.
MatrixXd products(const Places& places, int degree, bool total) {
  std::vector<Eigen::VectorXd> columns;
  std::vector<std::vector<double>> factor[3];
  for (Index l = 0; l < 3; ++l)
    for (Index i = 0; i < places.cols(); ++i) factor[l].push_back(chebyshev(places(l, i), degree));
  for (std::size_t a = 0; a <= static_cast<std::size_t>(degree); ++a)
    for (std::size_t b = 0; b <= static_cast<std::size_t>(degree); ++b)
      for (std::size_t c = 0; c <= static_cast<std::size_t>(degree); ++c) {
        if (total && a + b + c > static_cast<std::size_t>(degree)) continue;
        Eigen::VectorXd column(places.cols());
        for (Index i = 0; i < places.cols(); ++i) {
          const auto at = static_cast<std::size_t>(i);
          column[i] = factor[0][at][a] * factor[1][at][b] * factor[2][at][c];
        }
        columns.push_back(column);
      }
  MatrixXd values(places.cols(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) values.col(static_cast<Index>(k)) = columns[k];
  return values;
}

/// [point][harmonic polynomial], degrees up to `degree`: r^l P_l^m cos and sin, by their recurrences.
MatrixXd harmonics(const Places& places, int degree) {
  MatrixXd values(places.cols(), (degree + 1) * (degree + 1));
  for (Index i = 0; i < places.cols(); ++i) {
    const double x = places(0, i), y = places(1, i), z = places(2, i), squared = places.col(i).squaredNorm();
    Index column = 0;
    double cosine = 1, sine = 0;  // (x + iy)^m, scaled so that numbers stay near 1
    for (int m = 0; m <= degree; ++m) {
      double before = 0, now = 1;
      for (int l = m; l <= degree; ++l) {
        values(i, column++) = now * cosine;
        if (m > 0) values(i, column++) = now * sine;
        const double after = ((2 * l + 1) * z * now - (l + m) * squared * before) / (l - m + 1);
        before = now;
        now = after;
      }
      const double next = 2 * (x * cosine - y * sine);
      sine = 2 * (x * sine + y * cosine);
      cosine = next;
    }
  }
  return values;
}

/// Gauss's rule on [-1, 1] by the eigenvalues of its Jacobi matrix.
void gauss_rule(int count, Eigen::VectorXd& points, Eigen::VectorXd& weights) {
  MatrixXd jacobi = MatrixXd::Zero(count, count);
  for (int k = 1; k < count; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(jacobi);
  points = solver.eigenvalues();
  weights = 2 * solver.eigenvectors().row(0).transpose().array().square();
}

/// Least squares at nodes: values at x from values at the nodes.
MatrixXd fitted(const MatrixXd& at_x, const MatrixXd& at_nodes, const MatrixXd& values) {
  return at_x * at_nodes.colPivHouseholderQr().solve(values);
}

struct Attempt {
  std::size_t functions;
  double error;
};

class Comparison {
 public:
  /// Anderson's sphere of radius 1: Poisson's formula up to degree n, by a product of Gauss's rule and the trapezoidal one.
  Attempt on_sphere(int degree) const {
    Eigen::VectorXd heights, weights;
    gauss_rule(degree + 1, heights, weights);
    const int around = 2 * degree + 1;
    Places nodes(3, (degree + 1) * around);
    Eigen::VectorXd weight(nodes.cols());
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; b < around; ++b) {
        const double angle = 2 * std::numbers::pi * b / around, width = std::sqrt(1 - heights[a] * heights[a]);
        nodes.col(a * around + b) << width * std::cos(angle), width * std::sin(angle), heights[a];
        weight[a * around + b] = weights[a] / (2 * around);
      }
    MatrixXd poisson(x_.cols(), nodes.cols());
    for (Index i = 0; i < x_.cols(); ++i)
      for (Index k = 0; k < nodes.cols(); ++k) {
        const double along = x_.col(i).dot(nodes.col(k)), squared = x_.col(i).squaredNorm();
        double before = 0, now = 1, sum = 0;  // r^l P_l
        for (int l = 0; l <= degree; ++l) {
          sum += (2 * l + 1) * now;
          const double after = ((2 * l + 1) * along * now - l * squared * before) / (l + 1);
          before = now;
          now = after;
        }
        poisson(i, k) = weight[k] * sum;
      }
    return {static_cast<std::size_t>(nodes.cols()), error_of(poisson * potentials(nodes, y_))};
  }
  /// Harmonic polynomials, fitted at Chebyshev points of the second kind on the surface.
  Attempt harmonic(int degree) const {
    std::vector<double> along;
    for (int i = 0; i <= degree + 2; ++i) along.push_back(-0.5 * std::cos(std::numbers::pi * i / (degree + 2)));
    const Places all = tensor(along);
    std::vector<Index> surface;
    for (Index i = 0; i < all.cols(); ++i)
      if (all.col(i).cwiseAbs().maxCoeff() > 0.5 - 1e-12) surface.push_back(i);
    const Places nodes = all(Eigen::all, surface);
    const MatrixXd at_nodes = harmonics(nodes, degree);
    return {static_cast<std::size_t>(at_nodes.cols()),
            error_of(fitted(harmonics(x_, degree), at_nodes, potentials(nodes, y_)))};
  }
  Attempt polynomial(int degree, bool total) const {
    const Places nodes = tensor(chebyshev_points(degree + 1));
    const MatrixXd at_nodes = products(nodes, degree, total);
    // Chebyshev polynomials are orthogonal at these nodes: least squares is a mean.
    const Eigen::VectorXd squares = at_nodes.colwise().squaredNorm();
    const MatrixXd coefficients = squares.cwiseInverse().asDiagonal() * (at_nodes.transpose() * potentials(nodes, y_));
    return {static_cast<std::size_t>(at_nodes.cols()), error_of(products(x_, degree, total) * coefficients)};
  }
  /// No space of functions does better than the singular vectors.
  std::size_t best(double error) const {
    const Eigen::VectorXd values = Eigen::BDCSVD<MatrixXd>(exact_).singularValues();
    double left = 0;
    for (Index k = values.size(); k-- > 0;) {
      left += values[k] * values[k];
      if (std::sqrt(left) > error * exact_.norm()) return static_cast<std::size_t>(k) + 1;
    }
    return 0;
  }

 private:
  double error_of(const MatrixXd& approximate) const { return (approximate - exact_).norm() / exact_.norm(); }

  Places x_ = random_places(400, 1, 0), y_ = random_places(400, 2, 2);
  MatrixXd exact_ = potentials(x_, y_);
};

/// The fewest functions with which an error is reached.
std::size_t fewest(const std::vector<Attempt>& attempts, double error) {
  std::size_t found = 0;
  for (const Attempt& attempt : attempts)
    if (attempt.error <= error && (found == 0 || attempt.functions < found)) found = attempt.functions;
  return found;
}

}  // namespace

std::vector<KernelsBases> compare_bases(const std::vector<double>& errors) {
  const Comparison comparison;
  std::vector<Attempt> tensor_products, total, harmonic, sphere;
  for (int degree = 1; degree <= 9; ++degree) tensor_products.push_back(comparison.polynomial(degree, false));
  for (int degree = 1; degree <= 12; ++degree) total.push_back(comparison.polynomial(degree, true));
  for (int degree = 1; degree <= 12; ++degree) harmonic.push_back(comparison.harmonic(degree));
  for (int degree = 1; degree <= 30; ++degree) sphere.push_back(comparison.on_sphere(degree));
  std::vector<KernelsBases> rows;
  for (const double error : errors)
    rows.push_back({.error = error,
                    .tensor = fewest(tensor_products, error),
                    .total = fewest(total, error),
                    .harmonic = fewest(harmonic, error),
                    .sphere = fewest(sphere, error),
                    .best = comparison.best(error)});
  return rows;
}

}  // namespace gaussdrift::reproduce
