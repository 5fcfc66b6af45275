#include "blockmatrix/block_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace gaussdrift::blockmatrix {

namespace {

constexpr int highest_degree = 40;

[[noreturn]] void refuse(const std::string& what) { throw farfield::InvalidArgument("block matrix: " + what); }

void check_degree(int degree) {
  if (degree < 0 || degree > highest_degree)
    refuse("the degree is " + std::to_string(degree) + ", must lie in 0 to " + std::to_string(highest_degree));
}

void check_ascending(const Eigen::Ref<const Eigen::VectorXd>& points) {
  if (points.size() == 0) refuse("a matrix needs at least one point");
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i]))
      refuse("point " + std::to_string(i) + " is " + fmt::format("{}", points[i]) + "; points must be finite");
    if (i > 0 && points[i] < points[i - 1])
      refuse("point " + std::to_string(i) + ", " + fmt::format("{}", points[i]) + ", is below the one before it, " +
             fmt::format("{}", points[i - 1]) + "; points must ascend");
  }
}

class ListMaker {
 public:
  ListMaker(const Eigen::Ref<const Eigen::VectorXd>& points, std::size_t leaf_size)
      : points_(points), leaf_size_(leaf_size) {}

  void make(std::size_t row_begin, std::size_t row_end, std::size_t column_begin, std::size_t column_end) {
    const std::size_t rows = row_end - row_begin, columns = column_end - column_begin;
    if (rows <= leaf_size_ || columns <= leaf_size_) {
      list.push_back({row_begin, row_end, column_begin, column_end, false});
    } else if (admissible(row_begin, row_end, column_begin, column_end)) {
      list.push_back({row_begin, row_end, column_begin, column_end, true});
    } else {
      // The sheet's (lower + upper) / 2 belongs to the first half, counted from 1.
      const std::size_t row_middle = (row_begin + row_end + 1) / 2, column_middle = (column_begin + column_end + 1) / 2;
      make(row_begin, row_middle, column_begin, column_middle);
      make(row_middle, row_end, column_begin, column_middle);
      make(row_begin, row_middle, column_middle, column_end);
      make(row_middle, row_end, column_middle, column_end);
    }
  }

  std::vector<Block> list;

 private:
  double at(std::size_t i) const { return points_[static_cast<Eigen::Index>(i)]; }
  bool admissible(std::size_t row_begin, std::size_t row_end, std::size_t column_begin, std::size_t column_end) const {
    const double diameter = std::max(at(row_end - 1) - at(row_begin), at(column_end - 1) - at(column_begin));
    const double distance = std::max(at(column_begin) - at(row_end - 1), at(row_begin) - at(column_end - 1));
    return distance > 0 && diameter <= distance / 2;
  }

  const Eigen::Ref<const Eigen::VectorXd>& points_;
  std::size_t leaf_size_;
};

double value(LineKernel kernel, double x, double y) { return x == y ? 0 : kernel(x, y); }

}  // namespace

double log_kernel(double x, double y) { return std::log(std::abs(x - y)); }

double smooth_kernel(double x, double y) { return std::exp(x + y); }

Eigen::VectorXd chebyshev_points(int degree, double low, double high) {
  check_degree(degree);
  Eigen::VectorXd points(degree + 1);
  for (int k = 0; k <= degree; ++k)
    points[k] = (low + high) / 2 + (high - low) / 2 * std::cos(std::numbers::pi * (k + 0.5) / (degree + 1));
  return points;
}

// The barycentric formula; weights of the zeros of T_{n+1} are (-1)^k sin((k + 1/2) pi / (n + 1)).
Eigen::MatrixXd lagrange_matrix(int degree, double low, double high, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::VectorXd nodes = chebyshev_points(degree, low, high);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(x.size(), degree + 1);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (low == high) {
      result(i, 0) = 1;
      continue;
    }
    double sum = 0;
    bool at_node = false;
    for (int k = 0; k <= degree && !at_node; ++k) {
      const double distance = x[i] - nodes[k];
      at_node = distance == 0;
      if (at_node) {
        result.row(i).setZero();
        result(i, k) = 1;
        continue;
      }
      const double weight = std::sin(std::numbers::pi * (k + 0.5) / (degree + 1)) / distance;
      result(i, k) = k % 2 == 0 ? weight : -weight;
      sum += result(i, k);
    }
    if (!at_node) result.row(i) /= sum;
  }
  return result;
}

LowRank interpolate_kernel(LineKernel kernel, int degree, const Eigen::Ref<const Eigen::VectorXd>& rows,
                           const Eigen::Ref<const Eigen::VectorXd>& columns) {
  if (rows.size() == 0 || columns.size() == 0) refuse("a block needs rows and columns");
  const double row_low = rows.minCoeff(), row_high = rows.maxCoeff(), column_low = columns.minCoeff(),
               column_high = columns.maxCoeff();
  LowRank result;
  result.w = lagrange_matrix(degree, row_low, row_high, rows);
  result.v = lagrange_matrix(degree, column_low, column_high, columns);
  const Eigen::VectorXd xi = chebyshev_points(degree, row_low, row_high),
                        eta = chebyshev_points(degree, column_low, column_high);
  result.s.resize(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= degree; ++j) result.s(i, j) = kernel(xi[i], eta[j]);
  return result;
}

std::vector<Block> block_list(const Eigen::Ref<const Eigen::VectorXd>& points, std::size_t leaf_size) {
  check_ascending(points);
  if (leaf_size < 1) refuse("the leaf size is 0, must be at least 1");
  ListMaker maker(points, leaf_size);
  const std::size_t count = static_cast<std::size_t>(points.size());
  maker.make(0, count, 0, count);
  return std::move(maker.list);
}

std::size_t storage(const std::vector<Block>& blocks, int degree, Bases bases) {
  check_degree(degree);
  const std::size_t rank = static_cast<std::size_t>(degree) + 1;
  std::size_t sum = 0;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> sets;
  for (const Block& block : blocks) {
    if (!block.low_rank) {
      sum += block.rows() * block.columns();
    } else if (bases == Bases::of_blocks) {
      sum += (block.rows() + block.columns()) * rank + rank * rank;
    } else {
      sum += rank * rank;
      sets[{block.row_begin, block.row_end}] = block.rows();
      sets[{block.column_begin, block.column_end}] = block.columns();
    }
  }
  for (const auto& [range, size] : sets) sum += size * rank;
  return sum;
}

BlockMatrix::BlockMatrix(LineKernel kernel, const Eigen::Ref<const Eigen::VectorXd>& points,
                         const BlockOptions& options)
    : kernel_(kernel), options_(options), points_(points), blocks_(block_list(points, options.leaf_size)) {
  check_degree(options.degree);
  const double bytes = 8.0 * static_cast<double>(storage()) + 100.0 * static_cast<double>(blocks_.size());
  if (bytes > static_cast<double>(options.memory_limit))
    throw farfield::MemoryLimitError(
        fmt::format(
            "block matrix: the blocks would need {:.0f} MB, BlockOptions::memory_limit allows {:.0f} MB; raise it, or "
            "give fewer points",
            std::ceil(bytes / 1e6), std::floor(static_cast<double>(options.memory_limit) / 1e6)),
        bytes, options.memory_limit);
  const Eigen::Index rank = options.degree + 1;
  std::map<std::pair<std::size_t, std::size_t>, Basis> known;
  const auto basis = [&](std::size_t begin, std::size_t end) {
    if (options_.bases == Bases::shared) {
      const auto [found, fresh] = known.try_emplace({begin, end}, bases_.size());
      if (!fresh) return found->second;
    }
    const auto some = points_.segment(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
    bases_.push_back(lagrange_matrix(options_.degree, some[0], some[some.size() - 1], some));
    basis_range_.emplace_back(begin, end);
    return bases_.size() - 1;
  };
  for (const Block& block : blocks_) {
    first_.push_back(numbers_.size());
    const auto x = points_.segment(static_cast<Eigen::Index>(block.row_begin), static_cast<Eigen::Index>(block.rows()));
    const auto y =
        points_.segment(static_cast<Eigen::Index>(block.column_begin), static_cast<Eigen::Index>(block.columns()));
    if (block.low_rank) {
      row_basis_.push_back(basis(block.row_begin, block.row_end));
      column_basis_.push_back(basis(block.column_begin, block.column_end));
      const Eigen::VectorXd xi = chebyshev_points(options.degree, x[0], x[x.size() - 1]),
                            eta = chebyshev_points(options.degree, y[0], y[y.size() - 1]);
      for (Eigen::Index j = 0; j < rank; ++j)
        for (Eigen::Index i = 0; i < rank; ++i) numbers_.push_back(kernel(xi[i], eta[j]));
    } else {
      row_basis_.push_back(0);
      column_basis_.push_back(0);
      for (Eigen::Index j = 0; j < y.size(); ++j)
        for (Eigen::Index i = 0; i < x.size(); ++i) numbers_.push_back(value(kernel, x[i], y[j]));
    }
  }
}

Eigen::VectorXd BlockMatrix::operator*(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  if (x.size() != size())
    refuse("the vector has " + std::to_string(x.size()) + " entries, the matrix " + std::to_string(size()) +
           " columns");
  using Matrix = Eigen::Map<const Eigen::MatrixXd>;
  const Eigen::Index rank = options_.degree + 1;
  const bool shared = options_.bases == Bases::shared;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size());
  const auto part_of = [](auto& vector, const std::pair<std::size_t, std::size_t>& range) {
    return vector.segment(static_cast<Eigen::Index>(range.first),
                          static_cast<Eigen::Index>(range.second - range.first));
  };
  // With shared bases V^T x of every set of indices once, and W once for what its blocks have gathered.
  Eigen::MatrixXd moments, gathered;
  if (shared) {
    moments.resize(rank, static_cast<Eigen::Index>(bases_.size()));
    gathered = Eigen::MatrixXd::Zero(rank, moments.cols());
    for (std::size_t b = 0; b < bases_.size(); ++b)
      moments.col(static_cast<Eigen::Index>(b)).noalias() = bases_[b].transpose() * part_of(x, basis_range_[b]);
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const std::pair rows{block.row_begin, block.row_end}, columns{block.column_begin, block.column_end};
    if (!block.low_rank) {
      const double* const f = numbers_.data() + first_[b];
      if (block.rows() == 1 && block.columns() == 1) {
        y[static_cast<Eigen::Index>(block.row_begin)] += *f * x[static_cast<Eigen::Index>(block.column_begin)];
      } else {
        part_of(y, rows).noalias() +=
            Matrix(f, static_cast<Eigen::Index>(block.rows()), static_cast<Eigen::Index>(block.columns())) *
            part_of(x, columns);
      }
      continue;
    }
    const Matrix s(numbers_.data() + first_[b], rank, rank);
    const auto w = static_cast<Eigen::Index>(row_basis_[b]), v = static_cast<Eigen::Index>(column_basis_[b]);
    if (shared) {
      gathered.col(w).noalias() += s * moments.col(v);
    } else {
      const Eigen::VectorXd inner = bases_[column_basis_[b]].transpose() * part_of(x, columns);
      const Eigen::VectorXd outer = s * inner;
      part_of(y, rows).noalias() += bases_[row_basis_[b]] * outer;
    }
  }
  if (shared)
    for (std::size_t b = 0; b < bases_.size(); ++b)
      part_of(y, basis_range_[b]).noalias() += bases_[b] * gathered.col(static_cast<Eigen::Index>(b));
  return y;
}

Eigen::MatrixXd BlockMatrix::dense() const {
  Eigen::MatrixXd result(size(), size());
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(size());
  for (Eigen::Index j = 0; j < size(); ++j) {
    unit[j] = 1;
    result.col(j) = *this * unit;
    unit[j] = 0;
  }
  return result;
}

double BlockMatrix::squared_error() const {
  using Matrix = Eigen::Map<const Eigen::MatrixXd>;
  const Eigen::Index rank = options_.degree + 1;
  double sum = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if (!block.low_rank) continue;
    const Eigen::MatrixXd approximate =
        bases_[row_basis_[b]] * Matrix(numbers_.data() + first_[b], rank, rank) * bases_[column_basis_[b]].transpose();
    for (Eigen::Index j = 0; j < approximate.cols(); ++j)
      for (Eigen::Index i = 0; i < approximate.rows(); ++i) {
        const double difference =
            approximate(i, j) - kernel_(points_[static_cast<Eigen::Index>(block.row_begin) + i],
                                        points_[static_cast<Eigen::Index>(block.column_begin) + j]);
        sum += difference * difference;
      }
  }
  return sum;
}

}  // namespace gaussdrift::blockmatrix
