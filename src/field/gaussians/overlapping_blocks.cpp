#include "field/gaussians/overlapping_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

/// Halves of the longest side, again and again, until a part has at most `core` points.
template <int d>
void bisect(const fgtd::Points<d>& points, std::vector<Index>::iterator begin, std::vector<Index>::iterator end,
            std::size_t core, std::vector<std::vector<Index>>& parts) {
  const auto count = static_cast<std::size_t>(end - begin);
  if (count <= core) {
    parts.emplace_back(begin, end);
    return;
  }
  Eigen::Matrix<double, d, 1> low = points.col(*begin), high = low;
  for (auto it = begin; it != end; ++it) {
    low = low.cwiseMin(points.col(*it));
    high = high.cwiseMax(points.col(*it));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = begin + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(begin, middle, end, [&](Index a, Index b) {
    return points(axis, a) != points(axis, b) ? points(axis, a) < points(axis, b) : a < b;
  });
  bisect<d>(points, begin, middle, core, parts);
  bisect<d>(points, middle, end, core, parts);
}

/// The `wanted` points nearest to the bounding box of `part`, its own among them, in ascending order.
template <int d>
std::vector<Index> with_neighbours(const fgtd::Points<d>& points, const std::vector<Index>& part, std::size_t wanted) {
  Eigen::Matrix<double, d, 1> low = points.col(part[0]), high = low;
  for (const Index k : part) {
    low = low.cwiseMin(points.col(k));
    high = high.cwiseMax(points.col(k));
  }
  const auto count = static_cast<std::size_t>(points.cols());
  std::vector<std::pair<double, Index>> distance(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto x = points.col(static_cast<Index>(k));
    distance[k] = {(low - x).cwiseMax(x - high).cwiseMax(0.0).squaredNorm(), static_cast<Index>(k)};
  }
  wanted = std::min(wanted, count);
  std::nth_element(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(wanted - 1), distance.end());
  std::vector<Index> chosen;
  for (std::size_t i = 0; i < wanted; ++i) chosen.push_back(distance[i].second);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

template <int d>
Eigen::MatrixXd dense_gaussian_matrix(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma,
                                      double shift) {
  const Index count = points.cols(), columns = gaussian_columns(matrix, d);
  Eigen::MatrixXd dense(count * columns, count * columns);
  const Eigen::MatrixXd target = points.transpose();
  for (Index j = 0; j < count; ++j)
    for (Index k = 0; k < columns; ++k) {  // a column: the field of a unit coefficient
      const Eigen::VectorXd at = points.col(j), unit = Eigen::VectorXd::Unit(columns, k);
      sum_gaussian_pairs({.matrix = matrix,
                          .dimension = d,
                          .sigma = sigma,
                          .sources = 1,
                          .position = at.data(),
                          .coefficients = unit.data(),
                          .targets = static_cast<std::size_t>(count),
                          .target = target.data(),
                          .target_stride = static_cast<std::size_t>(count),
                          .values = dense.col(k * count + j).data(),
                          .value_stride = static_cast<std::size_t>(count)},
                         1);
    }
  dense.diagonal().array() += shift;
  return dense;
}

template <int d>
OverlappingBlocks<d>::OverlappingBlocks(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma,
                                        double shift, int threads, std::size_t memory_limit)
    : count_(points.cols()), columns_(gaussian_columns(matrix, d)), threads_(threads) {
  const bool one = count_ * columns_ <= dense_unknowns;
  const auto all = static_cast<std::size_t>(count_);
  std::vector<Index> order(all);
  std::iota(order.begin(), order.end(), Index{0});
  std::vector<std::vector<Index>> parts;
  bisect<d>(points, order.begin(), order.end(), one ? all : core, parts);
  const std::size_t wanted = one ? all : block_points;
  const double unknowns = static_cast<double>(wanted) * static_cast<double>(columns_);
  const double bytes = 8.0 * unknowns * unknowns * static_cast<double>(parts.size());
  if (bytes > static_cast<double>(memory_limit))
    throw InputError(
        fmt::format("a fit to {} samples would take {:.1f} GB; at most {:.1f} GB are used: fit fewer samples", count_,
                    bytes / 1e9, static_cast<double>(memory_limit) / 1e9));
  blocks_.resize(parts.size());
  // A Cholesky factorisation each.
  const base::Pieces pieces(parts.size(), 1e-10 * unknowns * unknowns * unknowns * static_cast<double>(parts.size()));
  base::parallel_for(pieces, threads, [&](std::size_t b) {
    Block& block = blocks_[b];
    block.points = with_neighbours<d>(points, parts[b], wanted);
    for (const Index k : parts[b]) {
      const auto place = std::lower_bound(block.points.begin(), block.points.end(), k);
      block.own.push_back(static_cast<Index>(place - block.points.begin()));
    }
    fgtd::Points<d> some(d, static_cast<Index>(block.points.size()));
    for (std::size_t i = 0; i < block.points.size(); ++i) some.col(static_cast<Index>(i)) = points.col(block.points[i]);
    block.factors.compute(dense_gaussian_matrix<d>(matrix, some, sigma, shift));
  });
}

template <int d>
Eigen::VectorXd OverlappingBlocks<d>::gathered(const Block& block, const Eigen::VectorXd& x) const {
  const auto size = static_cast<Index>(block.points.size());
  Eigen::VectorXd part(size * columns_);
  for (Index k = 0; k < columns_; ++k)
    for (Index i = 0; i < size; ++i) part[k * size + i] = x[k * count_ + block.points[static_cast<std::size_t>(i)]];
  return part;
}

template <int d>
Eigen::VectorXd OverlappingBlocks<d>::solve(const Eigen::VectorXd& x) const {
  std::vector<Eigen::VectorXd> parts(blocks_.size());
  const auto unknowns = static_cast<double>(blocks_.front().factors.rows());
  const double seconds = 1e-9 * unknowns * unknowns * static_cast<double>(blocks_.size());
  base::parallel_for({blocks_.size(), seconds}, threads_, [&](std::size_t b) {
    parts[b] = gathered(blocks_[b], x);
    blocks_[b].factors.solveInPlace(parts[b]);
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {  // in this order for any number of threads
    const auto size = static_cast<Index>(blocks_[b].points.size());
    for (Index k = 0; k < columns_; ++k)
      for (Index i = 0; i < size; ++i)
        sum[k * count_ + blocks_[b].points[static_cast<std::size_t>(i)]] += parts[b][k * size + i];
  }
  return sum;
}

template <int d>
double OverlappingBlocks<d>::reciprocal_condition() const {
  double worst = 1;
  for (const Block& block : blocks_)
    worst = std::min(worst, block.factors.info() == Eigen::Success ? block.factors.rcond() : 0.0);
  return worst;
}

// Without sample i the others predict it with the error B_i^-1 (A^-1 u)_i, B_i the diagonal block of A^-1 that belongs
// to i: changing u_i by that error makes the coefficients of i zero.
template <int d>
Eigen::VectorXd OverlappingBlocks<d>::left_out_errors(const Eigen::VectorXd& samples) const {
  constexpr std::size_t most = 24;
  const std::size_t looked_at = std::min(most, blocks_.size());
  Eigen::VectorXd errors = Eigen::VectorXd::Constant(count_, std::numeric_limits<double>::quiet_NaN());
  const auto unknowns = static_cast<double>(blocks_.front().factors.rows());
  const double seconds = 3e-10 * unknowns * unknowns * unknowns * static_cast<double>(looked_at);
  base::parallel_for({looked_at, seconds}, threads_, [&](std::size_t n) {
    const Block& block = blocks_[n * blocks_.size() / looked_at];
    const auto size = static_cast<Index>(block.points.size());
    const Eigen::VectorXd gamma = block.factors.solve(gathered(block, samples));
    const Eigen::MatrixXd inverse = block.factors.solve(Eigen::MatrixXd::Identity(gamma.size(), gamma.size()));
    for (const Index i : block.own) {
      const auto components = Eigen::seqN(i, columns_, size);
      const Eigen::MatrixXd own = inverse(components, components);
      const Eigen::VectorXd own_gamma = gamma(components);
      errors[block.points[static_cast<std::size_t>(i)]] = own.llt().solve(own_gamma).norm();
    }
  });
  return errors;
}

template class OverlappingBlocks<2>;
template class OverlappingBlocks<3>;
template Eigen::MatrixXd dense_gaussian_matrix<2>(GaussianMatrix, const fgtd::Points<2>&, double, double);
template Eigen::MatrixXd dense_gaussian_matrix<3>(GaussianMatrix, const fgtd::Points<3>&, double, double);

}  // namespace gaussdrift
