#include "reproduce/kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/stopwatch.hpp"
#include "blockmatrix/block_matrix.hpp"
#include "farfield/general.hpp"
#include "reproduce/bases_of_cube.hpp"

namespace gaussdrift::reproduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// [Boe22]: the error of interpolation of degree m falls as (eta / (eta + 1))^m.
KernelsRate rate_of(double eta) {
  constexpr int highest = 10;
  const double half = 0.5 / std::sqrt(3.0), distance = 1 / eta;  // of a cube of diameter 1
  const Vector3d along_axis(half + distance, 0, 0),
      along_diagonal = Vector3d::Constant(half + distance / std::sqrt(3.0));
  const VectorXd places = VectorXd::LinSpaced(9, -half, half);
  KernelsRate rate{.eta = eta, .stated = eta / (eta + 1)};
  for (int degree = 0; degree <= highest; ++degree) {
    const VectorXd nodes = blockmatrix::chebyshev_points(degree, -half, half);
    const MatrixXd lagrange = blockmatrix::lagrange_matrix(degree, -half, half, places);
    double worst = 0;
    for (const Vector3d& target : {along_axis, along_diagonal}) {
      // Values at the nodes are interpolated axis by axis: the columns of `values` are the pairs of the other two axes.
      const Index count = nodes.size(), fine = places.size();
      MatrixXd values(count, count * count);
      for (Index i = 0; i < count; ++i)
        for (Index j = 0; j < count * count; ++j)
          values(i, j) = 1 / (target - Vector3d(nodes[i], nodes[j / count], nodes[j % count])).norm();
      for (int axis = 0; axis < 3; ++axis) {
        const MatrixXd finer = lagrange * values;  // [fine][rest]
        // The first axis becomes the last one.
        const Index next = axis == 0   ? count
                           : axis == 1 ? count
                                       : fine,
                    rest = finer.cols() / (axis < 2 ? count : fine);
        MatrixXd turned(next, rest * fine);
        for (Index a = 0; a < next; ++a)
          for (Index b = 0; b < rest; ++b)
            for (Index c = 0; c < fine; ++c) turned(a, b * fine + c) = finer(c, a * rest + b);
        values = turned;
      }
      for (Index i = 0; i < fine; ++i)
        for (Index j = 0; j < fine * fine; ++j)
          worst = std::max(
              worst,
              std::abs(values(i, j) - 1 / (target - Vector3d(places[i], places[j / fine], places[j % fine])).norm()));
    }
    rate.error.push_back(worst * distance);
  }
  rate.factor = std::pow(rate.error.back() / rate.error[2], 1.0 / (highest - 2));
  return rate;
}

/// [Boe22]: the force of a cluster is that of one charge in its middle, up to diam / dist^3.
KernelsDecay decay_of(double diameter, double distance) {
  const double half = 0.5 * diameter / std::sqrt(3.0);
  const auto force = [](const Vector3d& x) { return Vector3d(x / std::pow(x.norm(), 3)); };
  KernelsDecay decay{.diameter = diameter, .distance = distance};
  const Vector3d target(half + distance, 0, 0);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d source((corner & 1) != 0 ? half : -half, (corner & 2) != 0 ? half : -half,
                          (corner & 4) != 0 ? half : -half);
    decay.error = std::max(decay.error, (force(target - source) - force(target)).norm());
  }
  decay.constant = decay.error * std::pow(distance, 3) / diameter;
  return decay;
}

/// A block of low rank: W S V^T by interpolation, as U diag(values) Z^T by QR and SVD.
struct Decomposed {
  MatrixXd left, right;
  VectorXd values;
};

Decomposed decomposed(const blockmatrix::LowRank& block) {
  const Eigen::HouseholderQR<MatrixXd> rows(block.w), columns(block.v);
  const Index m = std::min(block.w.rows(), block.w.cols()), n = std::min(block.v.rows(), block.v.cols());
  const MatrixXd upper_w = rows.matrixQR().topRows(m).triangularView<Eigen::Upper>(),
                 upper_v = columns.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixXd> svd(upper_w * block.s * upper_v.transpose(),
                                       Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {rows.householderQ() * MatrixXd::Identity(block.w.rows(), m) * svd.matrixU(),
          columns.householderQ() * MatrixXd::Identity(block.v.rows(), n) * svd.matrixV(), svd.singularValues()};
}

/// [Mel08, exercises 5 and 6] for one degree, and the same blocks from a higher degree, cut off by singular values so that
/// the error is no larger.
KernelsBlocks blocks_of(int degree) {
  const VectorXd points = VectorXd::LinSpaced(1024, 0, 1);
  const blockmatrix::BlockMatrix matrix(blockmatrix::log_kernel, points, {.degree = degree});
  KernelsBlocks row{.degree = degree, .doubles = matrix.storage(), .error = std::sqrt(matrix.squared_error())};
  struct Piece {
    const blockmatrix::Block* block;
    Decomposed parts;
    MatrixXd exact;
  };
  std::vector<Piece> pieces;
  std::size_t exact_doubles = 0;
  for (const blockmatrix::Block& block : matrix.blocks()) {
    if (!block.low_rank) {
      exact_doubles += block.rows() * block.columns();
      continue;
    }
    const auto rows = points.segment(static_cast<Index>(block.row_begin), static_cast<Index>(block.rows())),
               columns = points.segment(static_cast<Index>(block.column_begin), static_cast<Index>(block.columns()));
    MatrixXd exact(rows.size(), columns.size());
    for (Index i = 0; i < rows.size(); ++i)
      for (Index j = 0; j < columns.size(); ++j) exact(i, j) = blockmatrix::log_kernel(rows[i], columns[j]);
    pieces.push_back({&block,
                      decomposed(blockmatrix::interpolate_kernel(blockmatrix::log_kernel, degree + 4, rows, columns)),
                      exact});
  }
  const auto cut_off = [&](double below, bool measure) {
    double squares = 0;
    row.recompressed = exact_doubles;
    for (const Piece& piece : pieces) {
      Index rank = piece.parts.values.size();
      while (rank > 0 && piece.parts.values[rank - 1] < below) squares += std::pow(piece.parts.values[--rank], 2);
      row.recompressed += static_cast<std::size_t>(rank) * (piece.block->rows() + piece.block->columns());
      if (measure) {
        const MatrixXd kept = piece.parts.left.leftCols(rank) * piece.parts.values.head(rank).asDiagonal() *
                              piece.parts.right.leftCols(rank).transpose();
        row.recompressed_error += (kept - piece.exact).squaredNorm();
      }
    }
    return std::sqrt(squares);
  };
  double low = -40, high = 5;  // logarithms of singular values
  for (int i = 0; i < 50; ++i)
    (cut_off(std::exp(0.5 * (low + high)), false) <= 0.99 * row.error ? low : high) = 0.5 * (low + high);
  cut_off(std::exp(low), true);
  row.recompressed_error = std::sqrt(row.recompressed_error);
  return row;
}

template <int d>
farfield::Points<d> random_points(Index count) {
  std::mt19937 random(5);
  farfield::Points<d> points(d, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random()) * 0x1p-32;
  return points;
}

template <int d>
KernelsSum sum_of(const std::string& name, const farfield::KernelFunction& kernel, double tolerance,
                  const KernelsOptions& options) {
  const Index count = options.points, some = std::min<Index>(count, 500);
  const farfield::Points<d> points = random_points<d>(count);
  const VectorXd charges = VectorXd::Ones(count);
  const farfield::GeneralPlan<d> plan(
      kernel, points,
      {.tolerance = tolerance, .method = farfield::GeneralMethod::interpolation, .threads = options.threads});
  const base::Stopwatch evaluating;
  const VectorXd sums = plan.evaluate(charges);
  const double seconds = evaluating.seconds();
  const farfield::GeneralPlan<d> all_pairs(kernel, points, farfield::Points<d>(points.leftCols(some)),
                                           {.method = farfield::GeneralMethod::direct, .threads = options.threads});
  const base::Stopwatch summing;
  const VectorXd exact = all_pairs.evaluate(charges);
  const double direct = summing.seconds() * static_cast<double>(count) / static_cast<double>(some);
  const farfield::GeneralChoice& choice = plan.choice();
  return {.kernel = name,
          .dimension = d,
          .tolerance = tolerance,
          .error = (sums.head(some) - exact).norm() / std::sqrt(static_cast<double>(some)) /
                   (choice.kernel_size * static_cast<double>(count)),
          .measured = choice.measured,
          .megabytes = (choice.basis_bytes + choice.coupling_bytes) / 1e6,
          .rank = choice.levels.empty() ? 0 : choice.levels.back().rank,
          .build_seconds = choice.build_seconds,
          .seconds = seconds,
          .direct_seconds = direct};
}

KernelsOrders orders_of(bool variable, const KernelsOptions& options) {
  const farfield::Points<2> points = random_points<2>(std::max(20000, 4 * options.points));
  const farfield::GeneralPlan<2> plan(farfield::KernelFunction::inverse_power(1), points,
                                      {.tolerance = 1e-6,
                                       .method = farfield::GeneralMethod::interpolation,
                                       .threads = options.threads,
                                       .leaf_size = 12,
                                       .recompress = false,
                                       .variable_order = variable});
  const base::Stopwatch evaluating;
  plan.evaluate(VectorXd::Ones(points.cols()));
  KernelsOrders row{
      .variable = variable, .orders = {}, .seconds = evaluating.seconds(), .measured = plan.choice().measured};
  for (const farfield::GeneralLevel& level : plan.choice().levels) row.orders.push_back(level.order);
  row.megabytes = (plan.choice().basis_bytes + plan.choice().coupling_bytes) / 1e6;
  return row;
}

}  // namespace

bool KernelsReproduction::kept() const {
  return std::all_of(sums.begin(), sums.end(),
                     [](const KernelsSum& sum) { return sum.measured <= sum.tolerance && sum.error <= sum.tolerance; });
}

KernelsReproduction reproduce_kernels(const KernelsOptions& options,
                                      const std::function<void(const std::string&)>& progress) {
  const base::Stopwatch stopwatch;
  const auto tell = [&](const std::string& what) {
    if (progress) progress(what);
  };
  KernelsReproduction result{.options = options};
  tell("rates");
  for (const double eta : {2.0, 1.0, 0.5}) result.rates.push_back(rate_of(eta));
  for (const double diameter : {0.1, 0.01})
    for (const double distance : {1.0, 2.0, 4.0}) result.decays.push_back(decay_of(diameter, distance));
  tell("blocks");
  for (int degree = 1; degree <= 5; ++degree) result.blocks.push_back(blocks_of(degree));
  using farfield::KernelFunction;
  struct Named {
    std::string name;
    KernelFunction kernel;
  };
  for (const Named& named :
       {Named{"exp(-r)/r", KernelFunction::yukawa(1)}, Named{"exp(-10r)/r", KernelFunction::yukawa(10)},
        Named{"1/r^4", KernelFunction::inverse_power(4)}, Named{"exp(-10r^2)", KernelFunction::gaussian(10)}})
    for (const double tolerance : {1e-3, options.finest}) {
      tell(named.name);
      result.sums.push_back(sum_of<2>(named.name, named.kernel, tolerance, options));
      result.sums.push_back(sum_of<3>(named.name, named.kernel, tolerance, options));
    }
  tell("orders");
  for (const bool variable : {true, false}) result.orders.push_back(orders_of(variable, options));
  tell("bases");
  result.bases = compare_bases({1e-2, 1e-3, 1e-4, 1e-5});
  result.seconds = stopwatch.seconds();
  return result;
}

std::string to_text(const KernelsReproduction& result) {
  std::string text =
      "Interpolation of 1/r in a cube of diameter 1 at a distance of 1/eta: largest error times distance.\n"
      "Boerm 2022 states a factor of eta/(eta+1) from degree to degree.\n"
      "   eta   degree 2  degree 4  degree 6  degree 8  degree 10   factor  stated\n";
  for (const KernelsRate& row : result.rates)
    text += fmt::format("{:6.2f}   {:8.1e}  {:8.1e}  {:8.1e}  {:8.1e}  {:9.1e}   {:6.3f}  {:6.3f}\n", row.eta,
                        row.error[2], row.error[4], row.error[6], row.error[8], row.error[10], row.factor, row.stated);
  text +=
      "\nOne charge in the middle for a cube: largest error of the force. Boerm 2022 states diam/dist^3.\n"
      "  diam   dist     error  error dist^3/diam\n";
  for (const KernelsDecay& row : result.decays)
    text += fmt::format("{:6.2f}  {:5.1f}  {:8.1e}  {:17.3f}\n", row.diameter, row.distance, row.error, row.constant);
  text +=
      "\nln|x - y| in the blocks of Melenk's project 6, 1024 points, and the same blocks recompressed by QR and SVD\n"
      "  n   doubles     error   recompressed     error   ratio\n";
  for (const KernelsBlocks& row : result.blocks)
    text += fmt::format("{:3}  {:8}  {:8.1e}   {:12}  {:8.1e}   {:5.2f}\n", row.degree, row.doubles, row.error,
                        row.recompressed, row.recompressed_error,
                        static_cast<double>(row.doubles) / static_cast<double>(row.recompressed));
  text += fmt::format(
      "\nSums of {} points in the unit square and cube, charges 1, {} {}. The error is relative to the mean "
      "sum;\nmeasured is what the tolerance bounds.\n"
      "kernel        d  tolerance     error  measured      MB  rank   build s   sum s  all pairs s\n",
      result.options.points, result.options.threads, result.options.threads == 1 ? "thread" : "threads");
  for (const KernelsSum& row : result.sums)
    text += fmt::format("{:12} {:2}  {:9.0e}  {:8.1e}  {:8.1e}  {:6.1f}  {:4}  {:8.3f}  {:6.4f}  {:11.3f}\n",
                        row.kernel, row.dimension, row.tolerance, row.error, row.measured, row.megabytes, row.rank,
                        row.build_seconds, row.seconds, row.direct_seconds);
  text += fmt::format(
      "\nOrders by level, 1/r, {} points in the square, tolerance 1e-6, not recompressed\n"
      "                 measured      MB    sum s  orders from the largest clusters down\n",
      4 * result.options.points);
  for (const KernelsOrders& row : result.orders)
    text += fmt::format("{:15}  {:8.1e}  {:6.1f}  {:7.4f}  {}\n", row.variable ? "by level" : "one order", row.measured,
                        row.megabytes, row.seconds, fmt::join(row.orders, " "));
  text +=
      "\nFunctions that approximate 1/r in a cube for charges in the next cube but one, to a root mean square error\n"
      "   error  tensor products  total degree  harmonic  points on Anderson's sphere  singular vectors\n";
  const auto number = [](std::size_t count) { return count == 0 ? std::string("-") : std::to_string(count); };
  for (const KernelsBases& row : result.bases)
    text += fmt::format("{:8.0e}  {:>15}  {:>12}  {:>8}  {:>27}  {:>16}\n", row.error, number(row.tensor),
                        number(row.total), number(row.harmonic), number(row.sphere), number(row.best));
  return text + fmt::format("\n{}. {:.1f} s\n",
                            result.kept() ? "Every sum keeps its promise" : "A SUM BREAKS ITS PROMISE", result.seconds);
}

std::string to_json(const KernelsReproduction& result) {
  nlohmann::ordered_json json = {{"points", result.options.points}, {"threads", result.options.threads}};
  for (const char* list : {"rates", "decays", "blocks", "sums", "orders", "bases"})
    json[list] = nlohmann::ordered_json::array();
  for (const KernelsRate& row : result.rates)
    json["rates"].push_back({{"eta", row.eta}, {"errors", row.error}, {"factor", row.factor}, {"stated", row.stated}});
  for (const KernelsDecay& row : result.decays)
    json["decays"].push_back(
        {{"diameter", row.diameter}, {"distance", row.distance}, {"error", row.error}, {"constant", row.constant}});
  for (const KernelsBlocks& row : result.blocks)
    json["blocks"].push_back({{"degree", row.degree},
                              {"doubles", row.doubles},
                              {"error", row.error},
                              {"recompressed_doubles", row.recompressed},
                              {"recompressed_error", row.recompressed_error}});
  for (const KernelsSum& row : result.sums)
    json["sums"].push_back({{"kernel", row.kernel},
                            {"dimension", row.dimension},
                            {"tolerance", row.tolerance},
                            {"error", row.error},
                            {"measured", row.measured},
                            {"megabytes", row.megabytes},
                            {"rank", row.rank},
                            {"build_seconds", row.build_seconds},
                            {"seconds", row.seconds},
                            {"direct_seconds", row.direct_seconds}});
  for (const KernelsOrders& row : result.orders)
    json["orders"].push_back({{"variable", row.variable},
                              {"points", row.points},
                              {"orders", row.orders},
                              {"megabytes", row.megabytes},
                              {"seconds", row.seconds},
                              {"measured", row.measured}});
  for (const KernelsBases& row : result.bases)
    json["bases"].push_back({{"error", row.error},
                             {"tensor", row.tensor},
                             {"total", row.total},
                             {"harmonic", row.harmonic},
                             {"sphere", row.sphere},
                             {"best", row.best}});
  json["kept"] = result.kept();
  json["seconds"] = result.seconds;
  return json.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
