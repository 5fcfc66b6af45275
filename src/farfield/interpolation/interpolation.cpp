#include "farfield/interpolation/interpolation.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {
namespace {

/// Chebyshev-Lobatto points an axis: an even number, so that none lies on a plane of symmetry. With two fewer the fit
/// would amplify values of the function 200 times; with these it does less than 10 times (its Lebesgue constant). More
/// only cost time.
template <int d>
int points_an_axis(int degree) {
  const double enough = d == 3 ? (degree + 1) / std::sqrt(6.0) + 3.0 : degree / 2.0 + 4;
  return 2 * static_cast<int>(std::ceil(enough / 2));
}

/// How much a node counts in the fit. The field errs most at the corners of a cluster, since differentiating costs most
/// there, so nodes near edges and corners count more. Against equal weights the largest error falls by factors of 1.1
/// to 2.1. It stays within a quarter of that for exponents half or one and a half times as large.
template <int d>
double weight_of(const double* node) {
  double squared = 0, from_faces = 1;
  for (int l = 0; l < d; ++l) {
    squared += node[l] * node[l];
    from_faces *= 1.02 - 4 * node[l] * node[l];
  }
  return d == 3 ? std::pow(from_faces, -0.25) : squared * squared;
}

template <int d>
std::vector<double> surface_nodes(int points) {
  const std::size_t half = static_cast<std::size_t>(points) / 2;
  std::vector<double> axis;
  for (std::size_t i = 0; i < half; ++i)
    axis.push_back(std::cos(std::numbers::pi * static_cast<double>(i) / (points - 1)) / 2);
  std::vector<double> nodes;
  std::size_t all = 1;
  for (int l = 0; l < d; ++l) all *= half;
  for (std::size_t number = 0; number < all; ++number) {
    std::size_t at[d], rest = number;
    for (std::size_t& i : at) {
      i = rest % half;
      rest /= half;
    }
    if (*std::min_element(at, at + d) > 0) continue;  // inside
    for (const std::size_t i : at) nodes.push_back(axis[i]);
  }
  return nodes;
}

}  // namespace

template <int d>
std::size_t nodes_of_degree(int degree) {
  const std::size_t points = static_cast<std::size_t>(points_an_axis<d>(degree)), inner = points - 2;
  return d == 2 ? points * points - inner * inner : points * points * points - inner * inner * inner;
}

template <int d>
Interpolation<d>::Interpolation(int degree) : degree_(degree), node_(surface_nodes<d>(points_an_axis<d>(degree))) {
  const std::size_t count = functions<d>(degree), rows = octant();
  for (std::size_t k = 0; k < count; ++k) of_parity_[parity<d>(k)].push_back(k);
  std::vector<double> values(rows * count), importance(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    double t[d];
    for (std::size_t l = 0; l < d; ++l) t[l] = stretch * node_[i * d + l];
    evaluate_harmonics<d>(degree, t, values.data() + i * count);
    importance[i] = weight_of<d>(node_.data() + i * d);
  }
  for (unsigned p = 0; p < reflections; ++p) {
    const std::size_t columns = of_parity_[p].size();
    if (columns == 0) continue;
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    for (std::size_t k = 0; k < columns; ++k)
      for (std::size_t i = 0; i < rows; ++i)
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
            importance[i] * values[i * count + of_parity_[p][k]];
    const Eigen::VectorXd norm = matrix.colwise().norm();
    matrix.array().rowwise() /= norm.transpose().array();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
    // The pseudo-inverse R^-1 Q^T, its rows scaled back.
    Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
    Eigen::MatrixXd inverse =
        qr.matrixQR().topRows(matrix.cols()).template triangularView<Eigen::Upper>().solve(q.transpose());
    weight_[p].resize(rows * columns + padding);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        weight_[p][i * columns + k] = importance[i] *
                                      inverse(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) /
                                      norm[static_cast<Eigen::Index>(k)];
  }
}

template <int d>
void Interpolation<d>::fit(const double* values, double* coefficients) const {
  const std::size_t rows = octant();
  std::vector<double> part(rows), sum;
  for (unsigned p = 0; p < reflections; ++p) {
    const auto& set = of_parity_[p];
    for (std::size_t i = 0; i < rows; ++i) {
      part[i] = 0;
      for (std::size_t s = 0; s < reflections; ++s) part[i] += sign(p, s) * values[s * rows + i];
      part[i] /= static_cast<double>(reflections);
    }
    sum.assign(set.size(), 0.0);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < set.size(); ++k) sum[k] += weight_[p][i * set.size() + k] * part[i];
    for (std::size_t k = 0; k < set.size(); ++k) coefficients[set[k]] = sum[k];
  }
}

template <int d>
void Interpolation<d>::substitute(const double* moments, double* charges) const {
  const std::size_t rows = octant();
  std::fill_n(charges, nodes(), 0.0);
  for (unsigned p = 0; p < reflections; ++p) {
    const auto& set = of_parity_[p];
    for (std::size_t i = 0; i < rows; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < set.size(); ++k) sum += weight_[p][i * set.size() + k] * moments[set[k]];
      sum /= static_cast<double>(reflections);
      for (std::size_t s = 0; s < reflections; ++s) charges[s * rows + i] += sign(p, s) * sum;
    }
  }
}

template std::size_t nodes_of_degree<2>(int);
template std::size_t nodes_of_degree<3>(int);
template class Interpolation<2>;
template class Interpolation<3>;

}  // namespace farfield::detail
