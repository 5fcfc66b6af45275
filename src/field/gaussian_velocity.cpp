#include "field/gaussian_velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "field/divergence_free.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

bool is_fitted(GaussianKind kind) { return kind == GaussianKind::velocity || kind == GaussianKind::vorticity; }
bool is_curl(GaussianKind kind) { return kind == GaussianKind::vorticity || kind == GaussianKind::curl_coefficients; }

template <int d>
class GaussianVelocity : public VelocityField {
 public:
  GaussianVelocity(GaussianMatrix matrix, GaussianSum<d> sum, std::string description)
      : matrix_(matrix), sum_(std::move(sum)), description_(std::move(description)) {}

  void add(double /*t*/, const PointsView& x, const VectorsView& u) const override {
    fgtd::Points<d> targets(d, static_cast<Index>(x.count));
    for (int l = 0; l < d; ++l)
      targets.row(l) = Eigen::Map<const Eigen::RowVectorXd>(x.axis[static_cast<std::size_t>(l)], targets.cols());
    if (!targets.allFinite()) {  // a particle that has left for infinity: the caller says which
      for (int l = 0; l < d; ++l)
        Eigen::Map<Eigen::RowVectorXd>(u.axis[static_cast<std::size_t>(l)], targets.cols()) += 0 * targets.row(l);
      return;
    }
    const Eigen::MatrixXd values = sum_.evaluate(matrix_, targets);
    for (int l = 0; l < d; ++l)
      Eigen::Map<Eigen::VectorXd>(u.axis[static_cast<std::size_t>(l)], values.rows()) += values.col(l);
  }
  bool evaluates_in_blocks() const override { return sum_.pairwise(); }
  std::string describe() const override { return description_; }

 private:
  GaussianMatrix matrix_;
  GaussianSum<d> sum_;
  std::string description_;
};

/// The largest |u| at some of the points: a lower bound of max |u|.
template <int d>
double largest_velocity(GaussianMatrix matrix, const fgtd::Points<d>& points, const Eigen::MatrixXd& coefficients,
                        double sigma, int threads) {
  constexpr Index wanted = 200;
  const Index count = std::min(wanted, points.cols());
  fgtd::Points<d> some(d, count);
  for (Index i = 0; i < count; ++i) some.col(i) = points.col((2 * i + 1) * points.cols() / (2 * count));
  const GaussianSum<d> exact(points, coefficients, sigma, {.method = fgtd::Method::direct, .threads = threads});
  return exact.evaluate(matrix, some).cwiseAbs().maxCoeff();
}

template <int d>
std::unique_ptr<VelocityField> make(const std::vector<double>& positions, const std::vector<double>& numbers,
                                    const GaussianVelocityOptions& options) {
  const Index columns = gaussian_values(options.kind, d), count = static_cast<Index>(positions.size()) / d;
  const fgtd::Points<d> points = Eigen::Map<const fgtd::Points<d>>(positions.data(), d, count);
  const Eigen::MatrixXd values = Eigen::Map<const Eigen::MatrixXd>(numbers.data(), columns, count).transpose();
  const double width = options.width > 0 ? options.width : default_gaussian_width(d, positions);
  const double sigma = 1 / (width * width);
  const GaussianMatrix matrix = is_curl(options.kind) ? GaussianMatrix::curl : GaussianMatrix::field;

  std::string about = fmt::format("divergence-free Gaussians of width {:.4g} at {} points", width, count);
  Eigen::MatrixXd coefficients = values;
  if (is_fitted(options.kind)) {
    const GaussianMatrix sampled = is_curl(options.kind) ? GaussianMatrix::vorticity : GaussianMatrix::field;
    GaussianFitOptions fit_options = options.fit;
    fit_options.threads = options.threads;
    const GaussianFit fit = fit_gaussians<d>(sampled, points, values, sigma, fit_options);
    coefficients = fit.coefficients;
    about += fmt::format(
        ", fitted to their {} by {}: residual {:.1e}",
        options.kind == GaussianKind::velocity ? "velocities" : "vorticities",
        fit.iterations > 0 ? fmt::format("{} in {} iterations", fit.solver, fit.iterations) : fit.solver, fit.residual);
    if (options.fit.regularisation > 0)
      about += fmt::format(", regularisation {:.1e}, samples missed by up to {:.1e} of the largest",
                           options.fit.regularisation, fit.misfit);
  }
  about += "; div u = 0";

  GaussianSumOptions sum_options{.tolerance = 0.1,
                                 .derivative_order = matrix == GaussianMatrix::curl ? 1 : 2,
                                 .threads = options.threads,
                                 .expected_targets = options.expected_targets};
  const double largest = largest_velocity<d>(matrix, points, coefficients, sigma, options.threads);
  const double unit_error =
      GaussianSum<d>(points, coefficients, sigma, {.method = fgtd::Method::direct}).unit_error(matrix);
  if (unit_error > 0) {
    const double wanted = options.tolerance * largest / unit_error;
    if (!(wanted >= fgtd::smallest_tolerance))
      throw InputError(
          fmt::format("the Gaussians cancel: together they are {:.1e} times smaller than they could be, so a tolerance "
                      "of {:.0e} of the "
                      "velocity cannot be kept, {:.0e} can; lower width, set regularisation, or raise tolerance",
                      unit_error / largest, options.tolerance, fgtd::smallest_tolerance * unit_error / largest));
    sum_options.tolerance = std::min(wanted, 0.1);
  }
  return std::make_unique<GaussianVelocity<d>>(matrix, GaussianSum<d>(points, coefficients, sigma, sum_options), about);
}

}  // namespace

int gaussian_values(GaussianKind kind, int dimension) {
  return gaussian_columns(is_curl(kind) ? GaussianMatrix::curl : GaussianMatrix::field, dimension);
}

double default_gaussian_width(int dimension, const std::vector<double>& positions) {
  const auto d = static_cast<std::size_t>(dimension);
  double volume = 1, longest = 0;
  for (std::size_t l = 0; l < d; ++l) {
    double low = positions[l], high = low;
    for (std::size_t i = l; i < positions.size(); i += d)
      low = std::min(low, positions[i]), high = std::max(high, positions[i]);
    volume *= high - low;
    longest = std::max(longest, high - low);
  }
  const double count = static_cast<double>(positions.size() / d);
  if (volume > 0) return 2 * std::pow(volume / count, 1.0 / dimension);
  return longest > 0 ? 2 * longest / count : 1;  // points on a line or plane; one point
}

std::unique_ptr<VelocityField> make_gaussian_velocity(int dimension, const std::vector<double>& positions,
                                                      const std::vector<double>& values,
                                                      const GaussianVelocityOptions& options) {
  try {
    return dimension == 2 ? make<2>(positions, values, options) : make<3>(positions, values, options);
  } catch (const fgtd::Error& error) {
    throw InputError(std::string("the Gaussians of the velocity cannot be summed: ") + error.what() +
                     "; check width and the coordinates of the points");
  }
}

}  // namespace gaussdrift
