#include "field/gaussians/gaussian_velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <string>

#include "base/number.hpp"
#include "base/users_words.hpp"
#include "field/fit_errors.hpp"
#include "field/gaussians/divergence_free.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

bool is_curl(GaussianKind kind) { return kind == GaussianKind::vorticity || kind == GaussianKind::curl_coefficients; }

template <int d>
class GaussianVelocity : public VelocityField {
 public:
  using MakeSum = std::function<std::unique_ptr<GaussianSum<d>>()>;
  /// make_slopes: the same sum, prepared for one derivative more.
  GaussianVelocity(const GaussianModel& model, GaussianSum<d> sum, MakeSum make_slopes)
      : matrix_(model.matrix),
        sum_(std::move(sum)),
        make_slopes_(std::move(make_slopes)),
        errors_(d, model.positions, model.errors),
        description_(model.about) {}

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
  double cost() const override { return std::max(1.0, 0.04 * static_cast<double>(sum_.sources())); }
  // Each Gaussian is free of divergence, and derivatives from fgtd keep that to rounding [Sch06, Bemerkung 6.4.3].
  void add_divergence(double /*t*/, const PointsView& x, double* values) const override {
    for (int l = 0; l < d; ++l)
      Eigen::Map<Eigen::VectorXd>(values, static_cast<Index>(x.count)) +=
          0 * Eigen::Map<const Eigen::VectorXd>(x.axis[static_cast<std::size_t>(l)], static_cast<Index>(x.count));
  }
  // It needs one derivative more than the velocity, so it is a sum of its own, made when it is first asked for.
  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& gradients) const override {
    std::call_once(slopes_made_, [&] { slopes_ = make_slopes_(); });
    fgtd::Points<d> targets(d, static_cast<Index>(x.count));
    for (int l = 0; l < d; ++l)
      targets.row(l) = Eigen::Map<const Eigen::RowVectorXd>(x.axis[static_cast<std::size_t>(l)], targets.cols());
    for (std::size_t i = 0; i < d; ++i) {
      fgtd::Derivative<d> along{};
      along[i] = 1;
      const Eigen::MatrixXd values = slopes_->evaluate(matrix_, targets, along);
      for (std::size_t k = 0; k < d; ++k)
        Eigen::Map<Eigen::VectorXd>(gradients.slope[k][i], values.rows()) += values.col(static_cast<Index>(k));
    }
  }
  bool is_steady() const override { return true; }
  bool is_solenoidal() const override { return true; }
  bool evaluates_in_blocks() const override { return sum_.pairwise(); }
  bool is_fitted() const override { return errors_.known(); }
  double fit_error(const PointsView& near) const override { return errors_.near(near); }
  std::string describe() const override { return description_; }

 private:
  GaussianMatrix matrix_;
  GaussianSum<d> sum_;
  MakeSum make_slopes_;
  mutable std::once_flag slopes_made_;
  mutable std::unique_ptr<const GaussianSum<d>> slopes_;
  FitErrors errors_;
  std::string description_;
};

/// `wanted` of the points, evenly spaced, or all of them.
template <int d>
fgtd::Points<d> some_of(const fgtd::Points<d>& points, std::size_t wanted) {
  const Index count = std::min(static_cast<Index>(wanted), points.cols());
  fgtd::Points<d> some(d, count);
  for (Index i = 0; i < count; ++i) some.col(i) = points.col((2 * i + 1) * points.cols() / (2 * count));
  return some;
}

template <int d>
fgtd::Points<d> points_of(const std::vector<double>& positions) {
  return Eigen::Map<const fgtd::Points<d>>(positions.data(), d, static_cast<Index>(positions.size()) / d);
}

Eigen::MatrixXd rows_of(const std::vector<double>& numbers, Index count) {
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), static_cast<Index>(numbers.size()) / count, count)
      .transpose();
}

// The promise of fgtd is about single Gaussians. This is the tolerance with which the field keeps its own, relative to
// its largest value.
template <int d>
double term_tolerance(GaussianMatrix matrix, const fgtd::Points<d>& points, const Eigen::MatrixXd& coefficients,
                      double sigma, double tolerance, int threads) {
  const GaussianSum<d> pairs(points, coefficients, sigma, {.method = fgtd::Method::direct, .threads = threads});
  const double unit_error = pairs.unit_error(matrix);
  constexpr double coarsest = 0.1;  // nothing is gained above
  if (unit_error == 0) return coarsest;
  // max |u| from below, at some of the points and beside them: the velocity of a curl is 0 in its middle and largest
  // where sigma r^2 = 1/2.
  constexpr std::size_t looked_at = 100;
  fgtd::Points<d> places = some_of<d>(points, looked_at);
  double largest = pairs.evaluate(matrix, places).cwiseAbs().maxCoeff();
  for (int l = 0; l < d; ++l) {
    fgtd::Points<d> beside = places;
    beside.row(l).array() += std::sqrt(0.5 / sigma);
    largest = std::max(largest, pairs.evaluate(matrix, beside).cwiseAbs().maxCoeff());
  }
  const double wanted = tolerance * largest / unit_error;
  if (!(wanted >= fgtd::smallest_tolerance))
    throw GaussiansTooWide(fmt::format(
        "the Gaussians cancel: their sum is {:.1e} times smaller than its terms. A tolerance of {:.0e} of the velocity "
        "cannot be kept, {:g} can. Lower width, set regularisation, or raise tolerance.",
        unit_error / largest, tolerance, base::rounded_up(fgtd::smallest_tolerance * unit_error / largest, 2)));
  return std::min(wanted, coarsest);
}

/// The fit that `use` accepts: with the regularisation of the options or, where that may be chosen and Gaussians are
/// too wide without, with the least that will do. Points at random have some that nearly coincide.
template <int d, class Use>
GaussianFit fit_as_needed(const GaussianModelOptions& options, const fgtd::Points<d>& points,
                          const Eigen::MatrixXd& numbers, double sigma, const Use& use) {
  const GaussianMatrix sampled = is_curl(options.kind) ? GaussianMatrix::vorticity : GaussianMatrix::field;
  GaussianFitOptions how = options.fit;
  const auto fitted = [&] {
    GaussianFit fit = fit_gaussians<d>(sampled, points, numbers, sigma, how);
    use(fit, how.regularisation);
    return fit;
  };
  if (!options.regularise) return fitted();
  std::string why;
  for (const double tried : {0., 1e-12, 1e-10, 1e-8, 1e-6}) {
    how.regularisation = tried;
    try {
      GaussianFit fit = fitted();
      // A field that misses its samples is not what was asked for. So much smoothing is for the user to decide.
      constexpr double near_enough = 1e-2;
      if (tried == 0 || fit.misfit <= near_enough) return fit;
    } catch (const GaussiansTooWide& error) {
      if (why.empty()) why = error.what();
    } catch (const InputError&) {  // smoothed, samples that are too wild do not follow from each other either
      if (tried == 0) throw;
    }
  }
  // The end of the message is cut off: it recommends what was tried in vain.
  why.resize(std::min(why.size(), why.find(". Lower width")));
  throw InputError(why +
                   ". A regularisation up to 1e-6 does not help. Lower width, or remove samples that lie very close "
                   "together.");
}

template <int d>
GaussianModel make_model(const std::vector<double>& positions, const std::vector<double>& values,
                         const GaussianModelOptions& options) {
  const fgtd::Points<d> points = points_of<d>(positions);
  const Eigen::MatrixXd numbers = rows_of(values, points.cols());
  GaussianModel model;
  model.dimension = d;
  model.matrix = is_curl(options.kind) ? GaussianMatrix::curl : GaussianMatrix::field;
  model.width = options.width > 0 ? options.width : default_gaussian_width(d, positions);
  model.positions = positions;
  const double sigma = 1 / (model.width * model.width);
  if (!(std::isfinite(sigma) && sigma > 0))
    throw InputError(fmt::format("Gaussians of width {} are beyond double precision", model.width));

  model.about = fmt::format("divergence-free Gaussians of width {:.4g} at {} points", model.width, points.cols());
  Eigen::MatrixXd coefficients = numbers;
  const auto sum = [&] {
    model.term_tolerance =
        term_tolerance<d>(model.matrix, points, coefficients, sigma, options.tolerance, options.fit.threads);
  };
  if (is_fitted(options.kind)) {
    const GaussianFit fit = fit_as_needed<d>(options, points, numbers, sigma, [&](const GaussianFit& found, double by) {
      coefficients = found.coefficients;
      model.regularisation = by;
      sum();
    });
    // An error of the vorticity that changes its sign from sample to sample is a velocity of it / (pi / spacing).
    const double length = is_curl(options.kind) ? default_gaussian_width(d, positions) / (2 * std::numbers::pi) : 1;
    for (const double error : fit.left_out_errors) model.errors.push_back(length * error);
    model.about +=
        fmt::format(", fitted to their {} by {}: residual {:.1e}, samples follow from the others to {:.1e}",
                    options.kind == GaussianKind::velocity ? "velocities" : "vorticities",
                    fit.iterations > 0 ? fmt::format("{} in {} iterations", fit.solver, fit.iterations) : fit.solver,
                    fit.residual, fit.left_out);
    if (model.regularisation > 0)
      model.about += fmt::format(
          ", regularisation {:.1e}{}, samples missed by up to {:.1e} of the largest", model.regularisation,
          options.regularise ? " (chosen: without it the Gaussians can hardly be told apart)" : "", fit.misfit);
  } else {
    sum();
  }
  model.about += "; div u = 0";
  const Eigen::MatrixXd by_point = coefficients.transpose();
  model.coefficients.assign(by_point.data(), by_point.data() + by_point.size());
  return model;
}

template <int d>
std::unique_ptr<VelocityField> make_field(const GaussianModel& model, std::size_t expected_targets, int threads) {
  const auto prepared = [model, expected_targets, threads](int further_derivatives) {
    const fgtd::Points<d> points = points_of<d>(model.positions);
    const GaussianSumOptions options{
        .tolerance = model.term_tolerance,
        .derivative_order = (model.matrix == GaussianMatrix::curl ? 1 : 2) + further_derivatives,
        .threads = threads,
        .expected_targets = expected_targets};
    return GaussianSum<d>(points, rows_of(model.coefficients, points.cols()), 1 / (model.width * model.width), options);
  };
  const auto slopes = [prepared] { return std::make_unique<GaussianSum<d>>(prepared(1)); };
  return std::make_unique<GaussianVelocity<d>>(model, prepared(0), slopes);
}

// Errors of fgtd in the words of the case file.
template <class Work>
auto told_for_the_case(const Work& work) {
  try {
    return work();
  } catch (const fgtd::Error& error) {
    throw InputError(std::string("the Gaussians of the velocity cannot be summed: ") +
                     base::in_users_words(error.what(), {{"Options::tolerance = ", "velocity.tolerance = "}}) +
                     "; check width and the coordinates of the points");
  }
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

std::vector<std::string> gaussian_columns_of(GaussianKind kind, int dimension) {
  const std::vector<std::string> axes =
      dimension == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
  std::vector<std::string> names = axes;
  if (kind == GaussianKind::velocity) {
    for (const char* component : {"u", "v", "w"})
      if (names.size() < 2 * axes.size()) names.emplace_back(component);
    return names;
  }
  const std::string letter = kind == GaussianKind::vorticity ? "omega" : "gamma";
  if (gaussian_values(kind, dimension) == 1) {
    names.push_back(letter);
  } else {
    for (const std::string& axis : axes) names.push_back(letter + "_" + axis);
  }
  return names;
}

GaussianModel make_gaussian_model(int dimension, const std::vector<double>& positions,
                                  const std::vector<double>& values, const GaussianModelOptions& options) {
  return told_for_the_case([&] {
    return dimension == 2 ? make_model<2>(positions, values, options) : make_model<3>(positions, values, options);
  });
}

std::unique_ptr<VelocityField> make_gaussian_velocity(const GaussianModel& model, std::size_t expected_targets,
                                                      int threads) {
  return told_for_the_case([&] {
    return model.dimension == 2 ? make_field<2>(model, expected_targets, threads)
                                : make_field<3>(model, expected_targets, threads);
  });
}

}  // namespace gaussdrift
