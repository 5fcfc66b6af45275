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

template <int d>
std::vector<TriedShape> tried_shapes(Kernel kernel, const Points<d>& points, const Eigen::MatrixXd& values,
                                     double spacing, double ridge, double smallest_reciprocal, int threads) {
  const Index count = points.cols();
  const bool together = count <= whole;
  const Partition<d> partition(points, together ? count : own);
  const std::size_t parts = std::min(sampled_parts, partition.size());
  const Eigen::Array<double, 1, Eigen::Dynamic> sizes = values.colwise().squaredNorm().array().max(1e-300);
  const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  std::vector<TriedShape> tried;
  for (double shape = first_step * spacing; tried.empty() || shape <= 2 * extent; shape *= step) {
    std::vector<double> errors(parts), reciprocals(parts), looked_at(parts);
    const double equations = static_cast<double>(together ? count : around);
    gaussdrift::base::parallel_for(
        {parts, 1e-9 * equations * equations * equations * static_cast<double>(parts)}, threads, [&](std::size_t p) {
          const std::size_t part = p * partition.size() / parts;
          const std::vector<Index> neighbours = partition.neighbourhood(part, together ? count : around);
          const Points<d> some = chosen<d>(points, neighbours);
          const DenseSystem system =
              DenseSystem::of<d>({kernel, shape}, some, Frame<d>(some, positive_order(kernel)), ridge);
          if (!system.determines_polynomials()) return;
          reciprocals[p] = system.reciprocal_condition();
          if (reciprocals[p] < smallest_reciprocal) return;
          std::vector<Index> places;
          for (const Index k : partition.part(part))
            places.push_back(std::lower_bound(neighbours.begin(), neighbours.end(), k) - neighbours.begin());
          const Eigen::MatrixXd rows = system.weight_rows(places);
          Eigen::MatrixXd known(some.cols(), values.cols());
          for (std::size_t i = 0; i < neighbours.size(); ++i)
            known.row(static_cast<Index>(i)) = values.row(neighbours[i]);
          Eigen::MatrixXd wrong = rows * known;
          for (std::size_t i = 0; i < places.size(); ++i)
            wrong.row(static_cast<Index>(i)) /= rows(static_cast<Index>(i), places[i]);
          errors[p] = (wrong.colwise().squaredNorm().array() / sizes).sum();
        });
    if (*std::min_element(reciprocals.begin(), reciprocals.end()) < smallest_reciprocal) break;
    double error = 0;
    for (const double of_part : errors) error += of_part;
    tried.push_back({shape, std::sqrt(error)});
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
                                                 double, int);
template std::vector<TriedShape> tried_shapes<2>(Kernel, const Points<2>&, const Eigen::MatrixXd&, double, double,
                                                 double, int);
template std::vector<TriedShape> tried_shapes<3>(Kernel, const Points<3>&, const Eigen::MatrixXd&, double, double,
                                                 double, int);

}  // namespace rbf::detail
