#include "rbf/fit/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "rbf/fit/dense_system.hpp"
#include "rbf/fit/partition.hpp"

namespace rbf::detail {
namespace {

using Index = Eigen::Index;

constexpr Index sampled_points = 256;      // for the spacing
constexpr Index whole = 300;               // up to so many points are looked at together
constexpr std::size_t sampled_parts = 16;  // of more
constexpr Index own = 64, around = 240;    // points of a part, and of its equations
constexpr double first_step = 0.5, step = std::numbers::sqrt2;

}  // namespace

template <int d>
double typical_spacing(const Points<d>& points) {
  const Index count = points.cols(), sampled = std::min(count, sampled_points), near = std::min<Index>(8, count - 1);
  if (near < 1) return 0;
  constexpr double ball = d == 1 ? 2 : d == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
  std::vector<double> spacings;
  for (Index i = 0; i < sampled; ++i) {
    const Eigen::Matrix<double, d, 1> at = points.col(i * count / sampled);
    Eigen::VectorXd squares = (points.colwise() - at).colwise().squaredNorm();
    std::nth_element(squares.data(), squares.data() + near, squares.data() + count);
    spacings.push_back(std::sqrt(squares[near]) * std::pow(ball / static_cast<double>(near), 1.0 / d));
  }
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

namespace {

/// What a part of the points says of a shape.
struct PartOfShape {
  double reciprocal = 0;  // condition; 0 where there are too few points
  double errors = 0;      // of left-out values, squared, each column relative to its size
  DenseSystem::Gaussian gaussian;
};

template <int d>
PartOfShape judge_part(const Function& function, const Points<d>& points, const Eigen::MatrixXd& values,
                       const std::vector<Index>& neighbours, const std::vector<Index>& own_points,
                       double smallest_reciprocal, const FitOptions& options) {
  PartOfShape found;
  const Points<d> some = chosen<d>(points, neighbours);
  const DenseSystem system =
      DenseSystem::of<d>(function, some, Frame<d>(some, positive_order(function.kernel)), options.regularisation);
  if (!system.determines_polynomials()) return found;
  found.reciprocal = system.reciprocal_condition();
  if (found.reciprocal < smallest_reciprocal) return found;
  Eigen::MatrixXd known(some.cols(), values.cols());
  for (std::size_t i = 0; i < neighbours.size(); ++i) known.row(static_cast<Index>(i)) = values.row(neighbours[i]);
  if (options.shape_by == ShapeBy::likelihood) {
    found.gaussian = system.gaussian(known, system.solve(known));
    return found;
  }
  const Eigen::Array<double, 1, Eigen::Dynamic> sizes = values.colwise().squaredNorm().array().max(1e-300);
  std::vector<Index> places;
  for (const Index k : own_points)
    places.push_back(std::lower_bound(neighbours.begin(), neighbours.end(), k) - neighbours.begin());
  const Eigen::MatrixXd rows = system.weight_rows(places);
  Eigen::MatrixXd wrong = rows * known;
  for (std::size_t i = 0; i < places.size(); ++i)
    wrong.row(static_cast<Index>(i)) /= rows(static_cast<Index>(i), places[i]);
  found.errors = (wrong.colwise().squaredNorm().array() / sizes).sum();
  return found;
}

/// Of all parts; columns that are 0 say nothing. The likelihood takes parts as independent, with one tau for all of them:
/// -2 ln of it is m ln(tau^2) + ln det B, but for what does not depend on the shape.
double judgement(const std::vector<PartOfShape>& parts, ShapeBy by) {
  if (by == ShapeBy::left_out) {
    double errors = 0;
    for (const PartOfShape& part : parts) errors += part.errors;
    return std::sqrt(errors);
  }
  double numbers = 0, log_determinant = 0, sum = 0;
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(parts[0].gaussian.squares.size());
  for (const PartOfShape& part : parts) {
    numbers += static_cast<double>(part.gaussian.numbers);
    log_determinant += part.gaussian.log_determinant;
    squares += part.gaussian.squares;
  }
  for (const double of_column : squares)
    if (of_column > 0) sum += std::log(of_column / numbers) + log_determinant / numbers;
  return sum;
}

}  // namespace

template <int d>
std::vector<TriedShape> tried_shapes(Kernel kernel, const Points<d>& points, const Eigen::MatrixXd& values,
                                     double spacing, double smallest_reciprocal, const FitOptions& options) {
  const Index count = points.cols();
  const bool together = count <= whole;
  const Partition<d> partition(points, together ? count : own);
  const std::size_t parts = std::min(sampled_parts, partition.size());
  const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  std::vector<TriedShape> tried;
  for (double shape = first_step * spacing; tried.empty() || shape <= 2 * extent; shape *= step) {
    std::vector<PartOfShape> found(parts);
    const double equations = static_cast<double>(together ? count : around);
    gaussdrift::base::parallel_for({parts, 1e-9 * equations * equations * equations * static_cast<double>(parts)},
                                   options.threads, [&](std::size_t p) {
                                     const std::size_t part = p * partition.size() / parts;
                                     const std::vector<Index> neighbours =
                                         partition.neighbourhood(part, together ? count : around);
                                     found[p] = judge_part<d>({kernel, shape}, points, values, neighbours,
                                                              partition.part(part), smallest_reciprocal, options);
                                   });
    if (std::any_of(found.begin(), found.end(),
                    [&](const PartOfShape& part) { return part.reciprocal < smallest_reciprocal; }))
      break;
    tried.push_back({shape, judgement(found, options.shape_by)});
  }
  std::stable_sort(tried.begin(), tried.end(),
                   [](const TriedShape& a, const TriedShape& b) { return a.error < b.error; });
  return tried;
}

template <int d>
double unit_length(const Points<d>& points) {
  const double spacing = typical_spacing<d>(points);
  if (spacing > 0) return spacing;
  const double extent = points.cols() > 0 ? (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff() : 0;
  return extent > 0 ? extent : 1;
}

template double unit_length<1>(const Points<1>&);
template double unit_length<2>(const Points<2>&);
template double unit_length<3>(const Points<3>&);
template double typical_spacing<1>(const Points<1>&);
template double typical_spacing<2>(const Points<2>&);
template double typical_spacing<3>(const Points<3>&);
template std::vector<TriedShape> tried_shapes<1>(Kernel, const Points<1>&, const Eigen::MatrixXd&, double, double,
                                                 const FitOptions&);
template std::vector<TriedShape> tried_shapes<2>(Kernel, const Points<2>&, const Eigen::MatrixXd&, double, double,
                                                 const FitOptions&);
template std::vector<TriedShape> tried_shapes<3>(Kernel, const Points<3>&, const Eigen::MatrixXd&, double, double,
                                                 const FitOptions&);

}  // namespace rbf::detail
