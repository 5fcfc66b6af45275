// Fields fitted to scattered samples: they take the values of the samples, approach the true field with more of them,
// and what cannot be fitted is refused.
#include "field/gaussians/divergence_free_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "field/gaussians/divergence_free.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {
namespace {

using Index = Eigen::Index;

double halton(Index n, int base) {
  double value = 0, digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) value += static_cast<double>(n % base) * digit;
  return value;
}

// Scattered over [-1, 1]^d.
template <int d>
fgtd::Points<d> scattered(Index count) {
  constexpr int bases[] = {2, 3, 5};
  fgtd::Points<d> points(d, count);
  for (Index k = 0; k < count; ++k)
    for (int l = 0; l < d; ++l) points(l, k) = 2 * halton(k + 1, bases[l]) - 1;
  return points;
}

// Taylor-Green cells: u = (sin ax cos ay, -cos ax sin ay), div u = 0, curl u = 2 a sin ax sin ay. In 3D the same along
// (x, y) and (y, z), which has every component.
constexpr double a = 2;
template <int d>
Eigen::MatrixXd velocity(const fgtd::Points<d>& x) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(x.cols(), d);
  for (int l = 0; l + 1 < d; ++l) {
    const auto p = (a * x.row(l)).array().transpose(), q = (a * x.row(l + 1)).array().transpose();
    u.col(l).array() += p.sin() * q.cos();
    u.col(l + 1).array() -= p.cos() * q.sin();
  }
  return u;
}
template <int d>
Eigen::MatrixXd vorticity(const fgtd::Points<d>& x) {
  const auto sines = [&](int l) {
    return (2 * a * (a * x.row(l)).array().sin() * (a * x.row(l + 1)).array().sin()).transpose().matrix();
  };
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(x.cols(), d == 2 ? 1 : 3);
  if constexpr (d == 2) {
    w.col(0) = sines(0);
  } else {
    w.col(2) = sines(0);
    w.col(0) = sines(1);
  }
  return w;
}

double sigma_of(double width) { return 1 / (width * width); }

template <int d>
double spacing_of(Index count) {
  return 2 * std::pow(static_cast<double>(count), -1.0 / d);
}

template <int d>
double error_of_fit(Index count, double width) {
  const fgtd::Points<d> points = scattered<d>(count), targets = 0.7 * scattered<d>(200);
  const GaussianFit fit = fit_gaussians<d>(GaussianMatrix::field, points, velocity<d>(points), sigma_of(width));
  const GaussianSum<d> sum(points, fit.coefficients, sigma_of(width), {.method = fgtd::Method::direct});
  return (sum.evaluate(GaussianMatrix::field, targets) - velocity<d>(targets)).cwiseAbs().maxCoeff();
}

template <int d>
void takes_the_samples(GaussianMatrix matrix, Index count, const std::string& solver) {
  const fgtd::Points<d> points = scattered<d>(count);
  const Eigen::MatrixXd samples = matrix == GaussianMatrix::field ? velocity<d>(points) : vorticity<d>(points);
  // The matrix of a vorticity in the plane has no mean, so that narrow Gaussians tell little between the samples.
  const double sigma = sigma_of((matrix == GaussianMatrix::field ? 1.5 : 2.0) * spacing_of<d>(count));
  const GaussianFit fit = fit_gaussians<d>(matrix, points, samples, sigma, {.residual = 1e-5});
  EXPECT_EQ(fit.solver, solver);
  EXPECT_LE(fit.residual, 1.1e-5);
  const GaussianSum<d> sum(points, fit.coefficients, sigma, {.method = fgtd::Method::direct});
  const Eigen::MatrixXd difference = sum.evaluate(matrix, points) - samples;
  // What is stated is what is: between the two lies the rounding of the products.
  EXPECT_NEAR(difference.norm() / samples.norm(), fit.residual, 5.7e-14);
  EXPECT_NEAR(difference.cwiseAbs().maxCoeff() / samples.cwiseAbs().maxCoeff(), fit.misfit, 1.3e-13);
}

TEST(GaussianFit, TakesTheVelocitiesOfTheSamples) {
  takes_the_samples<2>(GaussianMatrix::field, 200, "cholesky");
  takes_the_samples<2>(GaussianMatrix::field, 900, "conjugate gradients");
  takes_the_samples<3>(GaussianMatrix::field, 200, "cholesky");
  takes_the_samples<3>(GaussianMatrix::field, 600, "conjugate gradients");
}

TEST(GaussianFit, TakesTheVorticitiesOfTheSamples) {
  takes_the_samples<2>(GaussianMatrix::vorticity, 400, "cholesky");
  takes_the_samples<2>(GaussianMatrix::vorticity, 1300, "conjugate gradients");
  takes_the_samples<3>(GaussianMatrix::vorticity, 200, "cholesky");
}

TEST(GaussianFit, ApproachesTheTrueFieldWithMoreSamples) {
  // Gaussians of two spacings: the error falls faster than the square of the spacing.
  const auto error_2d = [](Index count) { return error_of_fit<2>(count, 2 * spacing_of<2>(count)); };
  const auto error_3d = [](Index count) { return error_of_fit<3>(count, 2 * spacing_of<3>(count)); };
  EXPECT_LE(error_2d(50), error_2d(12) / std::pow(50.0 / 12, 2));  // the spacing to the fourth power
  EXPECT_LE(error_2d(400), error_2d(50) / 3);  // 8e-4 to 1.3e-4: less, as such Gaussians never tell the last digits
  EXPECT_LE(error_2d(400), 3e-4);
  EXPECT_LE(error_3d(160), error_3d(20) / 9);  // half the spacing; measured 27
}

TEST(GaussianFit, OfCoefficientsGivesThemBack) {
  const fgtd::Points<2> points = scattered<2>(100);
  const Eigen::MatrixXd gamma = velocity<2>(points);
  const double sigma = sigma_of(0.2);  // the spacing: well conditioned
  const GaussianSum<2> sum(points, gamma, sigma, {.method = fgtd::Method::direct});
  const GaussianFit fit =
      fit_gaussians<2>(GaussianMatrix::field, points, sum.evaluate(GaussianMatrix::field, points), sigma);
  EXPECT_LE((fit.coefficients - gamma).cwiseAbs().maxCoeff(), 2.7e-14);  // condition times rounding: 9e-15
}

std::string refusal(const fgtd::Points<2>& points, const Eigen::MatrixXd& samples, double width,
                    const GaussianFitOptions& options = {}) {
  try {
    fit_gaussians<2>(GaussianMatrix::field, points, samples, sigma_of(width), options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GaussianFit, RefusesWhatHasNoStableSolution) {
  const fgtd::Points<2> few = scattered<2>(100), many = scattered<2>(700);
  for (const auto& points : {few, many}) {
    const std::string wide = refusal(points, velocity<2>(points), 3.0);
    EXPECT_NE(wide.find("Gaussians of width 3 can hardly be told apart"), std::string::npos) << wide;
    EXPECT_NE(wide.find("Lower width"), std::string::npos);
  }
  // With regularisation the same has a solution that is near the samples.
  const GaussianFit smooth = fit_gaussians<2>(GaussianMatrix::field, few, velocity<2>(few), sigma_of(3.0),
                                              {.residual = 1e-4, .regularisation = 1e-9});
  EXPECT_LE(smooth.misfit, 3e-3);
  EXPECT_GT(smooth.misfit, smooth.residual);
}

TEST(GaussianFit, RefusesGaussiansThatDoNotBridgeTheSamples) {
  // The samples are met to rounding, but between them the field is nothing like the flow.
  const fgtd::Points<2> points = scattered<2>(200);
  const std::string narrow = refusal(points, velocity<2>(points), 0.7 * spacing_of<2>(200));
  EXPECT_NE(narrow.find("do not follow from each other"), std::string::npos) << narrow;
  EXPECT_NE(narrow.find("Raise width"), std::string::npos);
}

TEST(GaussianFit, TellsHowWellSamplesFollowFromTheOthers) {
  const Index count = 150;
  const double sigma = sigma_of(2 * spacing_of<2>(count));
  const fgtd::Points<2> points = scattered<2>(count);
  const Eigen::MatrixXd samples = velocity<2>(points);
  const GaussianFit fit = fit_gaussians<2>(GaussianMatrix::field, points, samples, sigma);
  double squares = 0;
  for (Index left_out = 0; left_out < count; ++left_out) {  // by fits to the others, one by one
    fgtd::Points<2> others(2, count - 1);
    Eigen::MatrixXd values(count - 1, 2);
    for (Index k = 0; k + 1 < count; ++k) {
      others.col(k) = points.col(k < left_out ? k : k + 1);
      values.row(k) = samples.row(k < left_out ? k : k + 1);
    }
    const GaussianSum<2> sum(others, fit_gaussians<2>(GaussianMatrix::field, others, values, sigma).coefficients, sigma,
                             {.method = fgtd::Method::direct});
    const fgtd::Points<2> place = points.col(left_out);
    squares += (sum.evaluate(GaussianMatrix::field, place) - samples.row(left_out)).squaredNorm();
  }
  EXPECT_NEAR(fit.left_out, std::sqrt(squares) / samples.norm(),
              2.5e-10 * fit.left_out);  // condition times rounding: 9e-11
}

TEST(GaussianFit, RefusesEqualPoints) {
  fgtd::Points<2> points = scattered<2>(50);
  points.col(30) = points.col(7);
  Eigen::MatrixXd samples = velocity<2>(points);
  EXPECT_NE(refusal(points, samples, 0.3).find("samples 8 and 31 are both at ("), std::string::npos)
      << refusal(points, samples, 0.3);
  samples(30, 0) += 1;
  EXPECT_NE(refusal(points, samples, 0.3).find("but have different values"), std::string::npos);
}

TEST(GaussianFit, RefusesOptionsOutOfRange) {
  const fgtd::Points<2> points = scattered<2>(10);
  EXPECT_NE(refusal(points, velocity<2>(points), 0.5, {.residual = 0}).find("residual = 0"), std::string::npos);
  EXPECT_NE(refusal(points, velocity<2>(points), 0.5, {.regularisation = -1}).find("regularisation = -1"),
            std::string::npos);
}

TEST(GaussianFit, HasTheSameBitsForEveryNumberOfThreads) {
  const fgtd::Points<2> points = scattered<2>(600);
  const auto fit = [&](int threads) {
    return fit_gaussians<2>(GaussianMatrix::field, points, velocity<2>(points), sigma_of(0.12), {.threads = threads})
        .coefficients;
  };
  EXPECT_EQ(fit(1), fit(2));
}

}  // namespace
}  // namespace gaussdrift
