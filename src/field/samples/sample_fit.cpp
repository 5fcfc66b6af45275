#include "field/samples/sample_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "rbf/integral.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

// Dense equations may be nearer to singular ones than an iteration stands, so that wider kernels are possible, with
// errors that are five times smaller. Their time grows with the cube: three seconds for most_dense_samples.

// A field without divergence has several times as many equations, and each width that is tried solves them. For more
// samples the width is that of a fit to each component.
constexpr std::size_t most_widths_tried = 200;

// Squares of samples and of coordinates are summed.
constexpr double largest_number = 1e100;

std::string in_the_words_of_a_case(const std::string& message) {
  return base::in_users_words(message, {{"FitOptions::regularisation", "regularisation"},
                                        {"FitOptions::memory_limit", "what a fit may hold"},
                                        {", or give 0 to have it chosen", ", or leave width out to have it chosen"},
                                        {"Lower the shape", "Lower width"},
                                        {" of shape ", " of width "},
                                        {"shape = ", "width = "}});
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named one : all) names.push_back(to_string(one));
  return names;
}

template <int d>
rbf::Points<d> points_of(const std::vector<double>& positions) {
  return Eigen::Map<const rbf::Points<d>>(positions.data(), d, static_cast<Index>(positions.size()) / d);
}

template <int d>
SampleFit fit_in(const rbf::Points<d>& points, const Eigen::MatrixXd& values, const SampleFitOptions& options) {
  const auto count = static_cast<std::size_t>(points.cols());
  const rbf::Kernel kernel = *rbf::kernel_named(options.kernel.empty() ? default_sample_kernel(count) : options.kernel);
  rbf::Function function{kernel, rbf::takes_shape(kernel) ? options.width : 0};
  rbf::FitOptions how{.accuracy = 1e-8,
                      .regularisation = options.regularisation,
                      .solver = count <= most_dense_samples ? rbf::Solver::dense : rbf::Solver::krylov,
                      .threads = options.threads};
  for (const rbf::ShapeBy by : rbf::ways_to_choose_a_shape())
    if (to_string(by) == options.width_by) how.shape_by = by;
  const Eigen::VectorXd sizes = values.rowwise().norm();
  const auto told = [&](const SampleFit::Function& fitted, const rbf::FitReport& report,
                        const Eigen::VectorXd& left_out) {
    double squares = 0;
    for (const double error : report.left_out) squares += error * error;
    SampleFit fit{.dimension = d, .function = fitted, .report = report};
    fit.width_was_chosen = rbf::takes_shape(kernel) && options.width == 0;
    for (int k = 0; k < d; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      fit.low[axis] = points.row(k).minCoeff() - report.spacing;
      fit.high[axis] = points.row(k).maxCoeff() + report.spacing;
    }
    fit.largest = sizes.maxCoeff();
    fit.typical_error = std::sqrt(squares);
    for (const double error : left_out)
      if (std::isfinite(error)) fit.largest_error = std::max(fit.largest_error, error);
    fit.errors = FitErrors(d, {points.data(), points.data() + points.size()}, {left_out.begin(), left_out.end()});
    if (!std::isfinite(fit.typical_error) || !std::isfinite(report.residual))
      throw InputError("the fit has no finite values; check the coordinates of the samples, width and regularisation");
    return fit;
  };
  if (options.divergence_free) {
    if (function.shape == 0 && count > most_widths_tried)
      function.shape = rbf::Interpolant<d>(function, points, values, how).report().function.shape;
    const rbf::DivergenceFreeInterpolant<d> fitted(function, points, values, how);
    return told(fitted, fitted.report(), fitted.left_out_errors());
  }
  const rbf::Interpolant<d> fitted(function, points, values, how);
  return told(fitted, fitted.report(), fitted.left_out_errors().rowwise().norm());
}

template <int d>
SampleIntegral integral_in(const rbf::Interpolant<d>& function, const Vector& low, const Vector& high) {
  Eigen::Matrix<double, d, 1> from, to;
  for (int k = 0; k < d; ++k) {
    from[k] = low[static_cast<std::size_t>(k)];
    to[k] = high[static_cast<std::size_t>(k)];
  }
  const rbf::Integral found = rbf::integral<d>(function, from, to);
  return {found.values[0], found.errors[0]};
}

}  // namespace

std::vector<std::string_view> sample_kernel_names() {
  static const std::vector<std::string> names = names_of(rbf::kernels());
  return {names.begin(), names.end()};
}

std::vector<std::string_view> width_by_names() {
  static const std::vector<std::string> names = names_of(rbf::ways_to_choose_a_shape());
  return {names.begin(), names.end()};
}

std::string default_sample_kernel(std::size_t samples) {
  return samples <= most_dense_samples ? "matern52" : "matern32";
}

bool SampleFit::is_smooth() const {
  // A field without divergence is made of second derivatives of its kernel.
  return rbf::continuous_derivatives(report.function.kernel) >= (is_divergence_free() ? 4 : 2);
}

SampleFit fit_samples(int dimension, const std::vector<double>& positions, const std::vector<double>& values,
                      const SampleFitOptions& options) {
  const auto count = static_cast<Index>(positions.size()) / dimension;
  if (static_cast<std::size_t>(count) < least_samples(dimension))
    throw InputError(fmt::format("{} {} too few to fit a function in {} dimensions; give {} at least", count,
                                 count == 1 ? "sample is" : "samples are", dimension, least_samples(dimension)));
  if (options.divergence_free && static_cast<std::size_t>(count) > most_divergence_free_samples(dimension))
    throw InputError(
        fmt::format("{} samples are too many for divergence_free = true, which has dense equations: at most {} in {} "
                    "dimensions. Leave samples out, or take gaussians in place of samples, which has no divergence "
                    "either and is solved by iteration",
                    count, most_divergence_free_samples(dimension), dimension));
  const auto check_size = [](const char* what, const std::vector<double>& numbers) {
    for (const double number : numbers)
      if (std::abs(number) > largest_number)
        throw InputError(fmt::format("the {} {:g} is too large for a fit in doubles; take other units", what, number));
  };
  check_size("sample", values);
  check_size("coordinate", positions);
  const Eigen::MatrixXd rows =
      Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Index>(values.size()) / count, count).transpose();
  try {
    return dimension == 2 ? fit_in<2>(points_of<2>(positions), rows, options)
                          : fit_in<3>(points_of<3>(positions), rows, options);
  } catch (const rbf::Error& error) {
    throw InputError("the samples cannot be fitted: " + in_the_words_of_a_case(error.what()));
  }
}

SampleIntegral integral_of(const SampleFit& fit, const Vector& low, const Vector& high) {
  Vector from = low, to = high;
  for (std::size_t k = 0; k < static_cast<std::size_t>(fit.dimension); ++k) {
    from[k] = std::max(low[k], fit.low[k]);
    to[k] = std::min(high[k], fit.high[k]);
    if (!(from[k] < to[k])) return {};
  }
  if (const auto* plane = std::get_if<rbf::Interpolant<2>>(&fit.function)) return integral_in<2>(*plane, from, to);
  return integral_in<3>(std::get<rbf::Interpolant<3>>(fit.function), from, to);
}

std::string describe(const SampleFit& fit) {
  const rbf::FitReport& report = fit.report;
  std::string text = to_string(report.function.kernel);
  if (rbf::takes_shape(report.function.kernel))
    text += fmt::format(" of width {:.4g}{}", report.function.shape, fit.width_was_chosen ? " (chosen)" : "");
  text += fmt::format("{} to {} samples about {:.2g} apart; left-out samples are missed by {:.1e} in the mean",
                      fit.is_divergence_free() ? ", without divergence," : "", report.points, report.spacing,
                      fit.typical_error);
  if (fit.largest_error > fit.typical_error) text += fmt::format(", {:.1e} at most", fit.largest_error);
  return text + fmt::format(", of {:.3g}", fit.largest);
}

SampleBox::SampleBox(const SampleFit& fit, Outside outside)
    : dimension_(fit.dimension), low_(fit.low), high_(fit.high), outside_(outside) {}

SampleBox::Placed SampleBox::place(const PointsView& x) const {
  Placed placed;
  for (std::size_t i = 0; i < x.count; ++i) {
    Vector at{};
    bool finite = true, inside = true;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
      at[k] = x.axis[k][i];
      finite = finite && std::isfinite(at[k]);
      inside = inside && low_[k] <= at[k] && at[k] <= high_[k];
      if (outside_ == Outside::clamp) at[k] = std::clamp(at[k], low_[k], high_[k]);
    }
    if (!finite || (!inside && outside_ == Outside::error)) {
      placed.lost.push_back(i);
    } else if (inside || outside_ == Outside::clamp) {
      placed.index.push_back(i);
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) placed.axis[k].push_back(at[k]);
    }
  }
  return placed;
}

bool SampleBox::varies(int axis, double coordinate) const {
  const auto k = static_cast<std::size_t>(axis);
  return outside_ != Outside::clamp || (low_[k] <= coordinate && coordinate <= high_[k]);
}

std::string SampleBox::why_lost(const Vector& x) const {
  if (outside_ != Outside::error) return "";
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k)
    if (!(low_[k] <= x[k] && x[k] <= high_[k]))
      return fmt::format(
          "{} = {} is outside of the samples, which reach from {} to {}, one spacing beyond the last of them included: "
          "say what stands there with outside = \"clamp\" or \"zero\", take samples of a larger region, shorten "
          "time.end, or move the density",
          "xyz"[k], base::told_apart(x[k], low_[k], high_[k]), base::told_apart(low_[k], x[k]),
          base::told_apart(high_[k], x[k]));
  return "";
}

}  // namespace gaussdrift
