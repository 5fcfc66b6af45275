// Matrices in blocks of low rank: the exercises of [Mel08] as facts.
#include "blockmatrix/block_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "farfield/naive.hpp"

namespace {

using gaussdrift::blockmatrix::Bases;
using gaussdrift::blockmatrix::Block;
using gaussdrift::blockmatrix::BlockMatrix;

/// x_i = (i - 1) h, h = 1 / (N - 1), [Mel08, (1)].
Eigen::VectorXd sheet_points(Eigen::Index count) { return Eigen::VectorXd::LinSpaced(count, 0, 1); }

Eigen::VectorXd random_points(Eigen::Index count, unsigned seed) {
  Eigen::VectorXd points = naive::cube<1>(count, seed).transpose();
  std::sort(points.begin(), points.end());
  return points;
}

Eigen::MatrixXd exact_matrix(gaussdrift::blockmatrix::LineKernel kernel, const Eigen::VectorXd& points) {
  Eigen::MatrixXd matrix(points.size(), points.size());
  for (Eigen::Index i = 0; i < points.size(); ++i)
    for (Eigen::Index j = 0; j < points.size(); ++j)
      matrix(i, j) = points[i] == points[j] ? 0 : kernel(points[i], points[j]);
  return matrix;
}

TEST(BlockList, HoldsEveryEntryExactlyOnce) {
  for (const Eigen::Index count : {1, 2, 3, 5, 16, 37, 200})
    for (const std::size_t leaf_size : {1U, 4U, 30U})
      for (const Eigen::VectorXd& points : {sheet_points(count), random_points(count, 1)}) {
        Eigen::MatrixXi times = Eigen::MatrixXi::Zero(count, count);
        for (const Block& block : gaussdrift::blockmatrix::block_list(points, leaf_size)) {
          times
              .block(static_cast<Eigen::Index>(block.row_begin), static_cast<Eigen::Index>(block.column_begin),
                     static_cast<Eigen::Index>(block.rows()), static_cast<Eigen::Index>(block.columns()))
              .array() += 1;
          EXPECT_TRUE(block.low_rank || std::min(block.rows(), block.columns()) <= leaf_size);
        }
        EXPECT_EQ(times.minCoeff(), 1);
        EXPECT_EQ(times.maxCoeff(), 1);
      }
}

TEST(BlockList, OfLowRankIsWhatIsAdmissibleAndNothingLargerThanThat) {
  const Eigen::VectorXd points = sheet_points(64);
  for (const Block& block : gaussdrift::blockmatrix::block_list(points)) {
    const auto at = [&](std::size_t i) { return points[static_cast<Eigen::Index>(i)]; };
    const double diameter =
        std::max(at(block.row_end - 1) - at(block.row_begin), at(block.column_end - 1) - at(block.column_begin));
    const double distance =
        std::max(at(block.column_begin) - at(block.row_end - 1), at(block.row_begin) - at(block.column_end - 1));
    EXPECT_TRUE(!block.low_rank || diameter <= distance / 2);
    // Halves of 64 = 2^6 points have equal sizes.
    EXPECT_EQ(block.rows(), block.columns());
  }
}

// N = 4: two intervals of two points are 1/3 apart and 1/3 wide, so all is divided down to single entries. N = 8: of 16
// blocks of 2 x 2, the 6 whose intervals are at least two apart have low rank.
TEST(BlockList, OfFewPointsIsThatOfTheSheet) {
  const auto four = gaussdrift::blockmatrix::block_list(sheet_points(4));
  EXPECT_EQ(four.size(), 16U);
  EXPECT_EQ(gaussdrift::blockmatrix::storage(four, 3), 16U);
  const auto eight = gaussdrift::blockmatrix::block_list(sheet_points(8));
  EXPECT_EQ(std::count_if(eight.begin(), eight.end(), [](const Block& block) { return block.low_rank; }), 6);
  EXPECT_EQ(eight.size(), 6U + 10 * 4);
  EXPECT_EQ(gaussdrift::blockmatrix::storage(eight, 1), 10U * 4 + 6 * (4 * 2 + 4));
  EXPECT_EQ(gaussdrift::blockmatrix::storage(eight, 1, Bases::shared), 10U * 4 + 6 * 4 + 4 * (2 * 2));
}

// Exercise 6a: N log N numbers.
TEST(BlockList, NeedsNumbersLikeNLogN) {
  for (const int degree : {0, 3, 5}) {
    double least = HUGE_VAL, most = 0;
    for (int i = 9; i <= 14; ++i) {
      const auto count = Eigen::Index{1} << i;
      const double numbers = static_cast<double>(
          gaussdrift::blockmatrix::storage(gaussdrift::blockmatrix::block_list(sheet_points(count)), degree));
      const double of_n_log_n = numbers / (static_cast<double>(count) * i);
      least = std::min(least, of_n_log_n);
      most = std::max(most, of_n_log_n);
      // Blocks of two by two need more numbers of low rank than as they are: N^2 is left behind at 2^11 only.
      EXPECT_TRUE(i < 11 || numbers < static_cast<double>(count) * static_cast<double>(count));
    }
    EXPECT_LT(most / least, 1.2) << degree;  // of a term like N; measured 1.12
  }
}

TEST(BlockList, SharedBasesNeedFewerNumbers) {
  const auto blocks = gaussdrift::blockmatrix::block_list(sheet_points(4096));
  for (const int degree : {0, 2, 5})
    EXPECT_LT(gaussdrift::blockmatrix::storage(blocks, degree, Bases::shared),
              gaussdrift::blockmatrix::storage(blocks, degree));
  // Single entries in the place of small blocks of rank n + 1: a larger leaf needs fewer numbers.
  EXPECT_LT(gaussdrift::blockmatrix::storage(gaussdrift::blockmatrix::block_list(sheet_points(4096), 8), 5),
            gaussdrift::blockmatrix::storage(blocks, 5));
}

TEST(BlockMatrix, ErrsByWhatItsBlocksOfLowRankErr) {
  for (const auto kernel : {gaussdrift::blockmatrix::log_kernel, gaussdrift::blockmatrix::smooth_kernel})
    for (const Eigen::VectorXd& points : {sheet_points(64), sheet_points(100), random_points(90, 2)})
      for (const Bases bases : {Bases::of_blocks, Bases::shared}) {
        const BlockMatrix matrix(kernel, points, {.degree = 2, .bases = bases});
        const double error = (matrix.dense() - exact_matrix(kernel, points)).squaredNorm();
        EXPECT_NEAR(matrix.squared_error(), error, 2.4e-14 * error);  // of rounding where entries cancel: 8e-15
        EXPECT_GT(error, 0);
        EXPECT_TRUE((matrix.dense().diagonal().array() == 0).all());
      }
}

// Exercise 6b: every degree lowers the Frobenius error by the same factor, which is ten or more: q = 0.101 below.
TEST(BlockMatrix, ErrorFallsExponentiallyWithTheDegree) {
  for (const Eigen::Index count : {64, 256}) {
    double last = HUGE_VAL;
    for (int degree = 0; degree <= 8; ++degree) {
      const double error = std::sqrt(
          BlockMatrix(gaussdrift::blockmatrix::log_kernel, sheet_points(count), {.degree = degree}).squared_error());
      EXPECT_LT(error, last / 10) << count << " points, degree " << degree;
      last = error;
    }
  }
}

TEST(BlockMatrix, MultipliesAsItsEntriesDo) {
  for (const Eigen::VectorXd& points : {sheet_points(1), sheet_points(2), sheet_points(128), random_points(201, 3)})
    for (const std::size_t leaf_size : {1U, 16U})
      for (const Bases bases : {Bases::of_blocks, Bases::shared}) {
        const BlockMatrix matrix(gaussdrift::blockmatrix::log_kernel, points,
                                 {.degree = 12, .leaf_size = leaf_size, .bases = bases});
        const Eigen::VectorXd x = naive::charges(points.size(), 4),
                              exact = exact_matrix(gaussdrift::blockmatrix::log_kernel, points) * x;
        // At degree 12 interpolation errs by 5e-14 in the nearest blocks alone; what is seen is rounding, 9e-16.
        EXPECT_LE((matrix * x - exact).cwiseAbs().maxCoeff(), 2.7e-15 * (1 + x.cwiseAbs().sum()));
      }
}

// Exercises 2 and 4: on admissible intervals ln |x - y| is interpolated to C q^n / (n + 1), whatever their size and
// distance. The nearest have the singularity five half lengths from their centre: q = 1 / (5 + sqrt(24)) = 0.101 for
// each variable, and the coefficients of a logarithm fall like q^n / n. Measured is C = 0.41 ... 0.49.
TEST(BlockMatrix, TheLogarithmIsInterpolatedEquallyWellAtEverySizeAndDistance) {
  constexpr double c = 0.5;
  const double q = 1 / (5 + std::sqrt(24.0));
  for (const double size : {1e-8, 1e-3, 1.0, 1e6})
    for (const double distance : {2.0, 3.0, 10.0, 1000.0})
      for (int degree = 0; degree <= 14; ++degree) {
        const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, 0, size),
                              y = Eigen::VectorXd::LinSpaced(40, size * (1 + distance), size * (2 + distance));
        const auto block =
            gaussdrift::blockmatrix::interpolate_kernel(gaussdrift::blockmatrix::log_kernel, degree, x, y);
        const Eigen::MatrixXd approximate = block.dense();
        double error = 0;
        for (Eigen::Index i = 0; i < x.size(); ++i)
          for (Eigen::Index j = 0; j < y.size(); ++j)
            error = std::max(error, std::abs(approximate(i, j) - gaussdrift::blockmatrix::log_kernel(x[i], y[j])));
        const double rounding = 7e-14;  // of ln, up to 18 here, with Lebesgue constants below 4: measured 2.5e-14
        EXPECT_LE(error, c * std::pow(q, degree) / (degree + 1) + rounding) << size << " " << distance << " " << degree;
      }
}

// Exercise 3: e^(x + y) with rank n + 1, and ||M - M^n||_F below N times the error of one variable, which is at most
// e * 2 (1/4)^(n+1) / (n+1)! times e of the other. In root mean square both together are 0.34 to 0.43 of that.
TEST(BlockMatrix, ASmoothKernelHasLowRankAsAWhole) {
  for (const Eigen::Index count : {50, 200}) {
    const Eigen::VectorXd points = sheet_points(count);
    Eigen::MatrixXd exact(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) exact(i, j) = std::exp(points[i] + points[j]);
    for (int degree = 0; degree <= 8; ++degree) {
      const auto low_rank =
          gaussdrift::blockmatrix::interpolate_kernel(gaussdrift::blockmatrix::smooth_kernel, degree, points, points);
      EXPECT_EQ(low_rank.w.cols(), degree + 1);
      const double one_variable = 2 * std::exp(2.0) * std::pow(0.25, degree + 1) / std::tgamma(degree + 2);
      EXPECT_LE((low_rank.dense() - exact).norm(), one_variable * static_cast<double>(count)) << degree;
    }
    const Eigen::VectorXd singular =
        gaussdrift::blockmatrix::interpolate_kernel(gaussdrift::blockmatrix::smooth_kernel, 3, points, points)
            .dense()
            .jacobiSvd()
            .singularValues();
    EXPECT_LT(singular[4], 2.2e-16 * singular[0]);  // a rounding unit of the largest
  }
}

TEST(ToeplitzMatrix, MultipliesAsItsEntriesDo) {
  for (const Eigen::Index count : {1, 2, 3, 8, 37, 256}) {
    const Eigen::VectorXd points = sheet_points(std::max<Eigen::Index>(2, count));
    Eigen::VectorXd column(count), row(count);
    for (Eigen::Index k = 0; k < count; ++k) column[k] = k == 0 ? 0 : gaussdrift::blockmatrix::log_kernel(points[k], 0);
    row = 2 * column;  // not symmetric
    Eigen::MatrixXd dense(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) dense(i, j) = i >= j ? column[i - j] : row[j - i];
    const Eigen::VectorXd x = naive::charges(count, 5);
    EXPECT_LE(((gaussdrift::blockmatrix::ToeplitzMatrix(column, row) * x) - dense * x).cwiseAbs().maxCoeff(),
              7e-14);  // sums up to 50 by transforms of length 512; measured 2.5e-14
  }
}

TEST(BlockMatrix, RefusesWrongInput) {
  const auto matrix = [](const Eigen::VectorXd& points, const gaussdrift::blockmatrix::BlockOptions& options) {
    return BlockMatrix(gaussdrift::blockmatrix::log_kernel, points, options);
  };
  EXPECT_THROW(matrix(Eigen::VectorXd(0), {}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(Eigen::Vector3d(0, 2, 1), {}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(Eigen::Vector2d(0, std::nan("")), {}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(sheet_points(4), {.degree = -1}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(sheet_points(4), {.degree = 41}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(sheet_points(4), {.leaf_size = 0}), farfield::InvalidArgument);
  EXPECT_THROW(matrix(sheet_points(4096), {.memory_limit = 100'000}), farfield::MemoryLimitError);
  EXPECT_THROW(matrix(sheet_points(4), {}) * Eigen::VectorXd(5), farfield::InvalidArgument);
  EXPECT_THROW(gaussdrift::blockmatrix::ToeplitzMatrix(Eigen::VectorXd(0), Eigen::VectorXd(0)),
               farfield::InvalidArgument);
  EXPECT_THROW(gaussdrift::blockmatrix::ToeplitzMatrix(Eigen::Vector2d(1, 2), Eigen::Vector2d(3, 2)),
               farfield::InvalidArgument);
  EXPECT_THROW(
      gaussdrift::blockmatrix::ToeplitzMatrix(Eigen::Vector2d(1, 2), Eigen::Vector2d(1, 2)) * Eigen::VectorXd(3),
      farfield::InvalidArgument);
}

}  // namespace
