// Do interpolants of values and gradients, and fields without divergence, take their data, and converge?
#include "rbf/generalized.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rbf/naive.hpp"

namespace {

using Index = Eigen::Index;

using naive::cube;

/// sin(3 x) cos(2 y) and the like, and its gradient.
template <int d>
Eigen::VectorXd wave(const rbf::Points<d>& x) {
  return ((3 * x.row(0)).array().sin() * (2 * x.row(d - 1)).array().cos()).transpose();
}
template <int d>
Eigen::MatrixXd slopes(const rbf::Points<d>& x) {
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(x.cols(), d);
  const auto a = (3 * x.row(0)).array().transpose(), b = (2 * x.row(d - 1)).array().transpose();
  found.col(0).array() += 3 * a.cos() * b.cos();
  found.col(d - 1).array() -= 2 * a.sin() * b.sin();
  return found;
}

std::vector<rbf::Kernel> smooth_kernels() {
  std::vector<rbf::Kernel> all;
  for (const rbf::Kernel kernel : rbf::kernels())
    if (rbf::highest_derivative(kernel) == 2) all.push_back(kernel);
  return all;
}

class EveryGeneralizedInterpolant : public testing::TestWithParam<rbf::Kernel> {};
INSTANTIATE_TEST_SUITE_P(Rbf, EveryGeneralizedInterpolant, testing::ValuesIn(smooth_kernels()), [](const auto& of) {
  return naive::name({of.param, 0});
});

template <int d>
void takes_values_and_gradients(rbf::Kernel kernel) {
  const rbf::Points<d> points = cube<d>(25, 1), slope_points = cube<d>(20, 2);
  const double shape = d == 1 ? 0.05 : 0.3;
  const rbf::HermiteInterpolant<d> fit({kernel, shape}, points, wave<d>(points), slope_points, slopes<d>(slope_points));
  EXPECT_LE((fit.evaluate(points) - wave<d>(points)).cwiseAbs().maxCoeff(), 1e-6) << fit.report();
  for (std::size_t l = 0; l < d; ++l) {
    rbf::Derivative<d> along{};
    along[l] = 1;
    EXPECT_LE(
        (fit.evaluate(slope_points, along) - slopes<d>(slope_points).col(static_cast<Index>(l))).cwiseAbs().maxCoeff(),
        1e-5)
        << fit.report();
  }
}

TEST_P(EveryGeneralizedInterpolant, TakesValuesAndGradients) {
  if (GetParam() == rbf::Kernel::matern32) takes_values_and_gradients<1>(GetParam());
  takes_values_and_gradients<2>(GetParam());
  takes_values_and_gradients<3>(GetParam());
}

TEST_P(EveryGeneralizedInterpolant, GradientsMakeAFitBetter) {
  const rbf::Points<2> points = cube<2>(120, 3), targets = cube<2>(200, 4);
  const rbf::Points<2> none(2, 0);
  const bool flat = GetParam() == rbf::Kernel::gaussian || GetParam() == rbf::Kernel::multiquadric;
  const auto error = [&](const rbf::Points<2>& slope_points) {
    const rbf::HermiteInterpolant<2> fit({GetParam(), flat ? 0.1 : 0.15}, points, wave<2>(points), slope_points,
                                         slopes<2>(slope_points));
    return (fit.evaluate(targets) - wave<2>(targets)).norm();
  };
  // Kernels with few derivatives gain less by them.
  const bool rough = GetParam() == rbf::Kernel::matern32 || GetParam() == rbf::Kernel::matern52;
  EXPECT_LE(error(points), error(none) / (rough ? 1.1 : 2));
  // Without gradients it is the Interpolant.
  const rbf::HermiteInterpolant<2> hermite({GetParam(), 0.1}, points, wave<2>(points), none, Eigen::MatrixXd(0, 2));
  const rbf::Interpolant<2> plain({GetParam(), 0.1}, points, wave<2>(points));
  EXPECT_LE((hermite.evaluate(targets) - plain.evaluate(targets)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(hermite.report().left_out[0] / plain.report().left_out[0], 1, 1e-6);
}

/// Vortices: u = (psi_y, -psi_x) in two dimensions, and the same in two planes in three.
template <int d>
Eigen::MatrixXd flow(const rbf::Points<d>& x) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(x.cols(), d);
  for (int l = 0; l + 1 < d; ++l) {
    const auto p = (4 * x.row(l)).array().transpose(), q = (4 * x.row(l + 1)).array().transpose();
    u.col(l).array() += p.sin() * q.cos();
    u.col(l + 1).array() -= p.cos() * q.sin();
  }
  return u;
}

template <int d>
void takes_vectors_without_divergence(rbf::Kernel kernel) {
  const rbf::Points<d> points = cube<d>(40, 5), targets = cube<d>(10, 6);
  const rbf::DivergenceFreeInterpolant<d> fit({kernel, 0.3}, points, flow<d>(points));
  EXPECT_LE((fit.evaluate(points) - flow<d>(points)).cwiseAbs().maxCoeff(), 1e-6) << fit.report();
  const double step = 1e-4;
  Eigen::VectorXd divergence = Eigen::VectorXd::Zero(10);
  double size = 0;
  for (int l = 0; l < d; ++l) {
    rbf::Points<d> ahead = targets, behind = targets;
    ahead.row(l).array() += step;
    behind.row(l).array() -= step;
    const Eigen::VectorXd slope = (fit.evaluate(ahead) - fit.evaluate(behind)).col(l) / (2 * step);
    divergence += slope;
    size = std::max(size, slope.cwiseAbs().maxCoeff());
  }
  // Differences are right to the step squared times third derivatives, 1/shape^2 times the first.
  EXPECT_LE(divergence.cwiseAbs().maxCoeff(), (kernel == rbf::Kernel::matern32 ? 1e-2 : 1e-5) * size);
}

template <int d>
void has_the_gradient_of_its_field(rbf::Kernel kernel) {
  const rbf::Points<d> points = cube<d>(30, 5), targets = cube<d>(10, 6);
  const rbf::DivergenceFreeInterpolant<d> fit({kernel, 0.3}, points, flow<d>(points));
  const Eigen::MatrixXd slopes = fit.gradient(targets);
  const double size = slopes.cwiseAbs().maxCoeff(), step = 1e-4;
  Eigen::VectorXd divergence = Eigen::VectorXd::Zero(10);
  for (int l = 0; l < d; ++l) {
    rbf::Points<d> ahead = targets, behind = targets;
    ahead.row(l).array() += step;
    behind.row(l).array() -= step;
    const Eigen::MatrixXd difference = (fit.evaluate(ahead) - fit.evaluate(behind)) / (2 * step);
    // Right to the step squared times third derivatives, as above.
    EXPECT_LE((difference - slopes.middleCols(d * l, d)).cwiseAbs().maxCoeff(),
              (kernel == rbf::Kernel::matern32 ? 1e-2 : 1e-5) * size)
        << rbf::to_string(kernel) << l;
    divergence += slopes.col(l + d * l);
  }
  EXPECT_LE(divergence.cwiseAbs().maxCoeff(), 1e-9 * size) << rbf::to_string(kernel);  // large weights cancel
}

TEST_P(EveryGeneralizedInterpolant, HasTheGradientOfItsFieldWithoutDivergence) {
  has_the_gradient_of_its_field<2>(GetParam());
  has_the_gradient_of_its_field<3>(GetParam());
}

TEST_P(EveryGeneralizedInterpolant, TakesVectorsWithoutDivergence) {
  takes_vectors_without_divergence<2>(GetParam());
  takes_vectors_without_divergence<3>(GetParam());
}

TEST(DivergenceFreeInterpolant, PredictsLeftOutVectors) {
  const Index count = 25;
  const rbf::Function function{rbf::Kernel::gaussian, 0.3};
  const rbf::Points<2> points = cube<2>(count, 7);
  const Eigen::MatrixXd vectors = flow<2>(points);
  double squares = 0;
  for (Index out = 0; out < count; ++out) {
    rbf::Points<2> others(2, count - 1);
    Eigen::MatrixXd known(count - 1, 2);
    for (Index k = 0; k + 1 < count; ++k) {
      others.col(k) = points.col(k < out ? k : k + 1);
      known.row(k) = vectors.row(k < out ? k : k + 1);
    }
    const rbf::DivergenceFreeInterpolant<2> fit(function, others, known);
    squares += (fit.evaluate(points.col(out)) - vectors.row(out)).squaredNorm();
  }
  const rbf::DivergenceFreeInterpolant<2> fit(function, points, vectors);
  EXPECT_NEAR(fit.report().left_out[0] / std::sqrt(squares / static_cast<double>(count)), 1, 1e-5);
}

TEST(DivergenceFreeInterpolant, HasADefaultThatWorksOnRandomPoints) {
  for (const rbf::Kernel kernel : {rbf::Kernel::gaussian, rbf::Kernel::multiquadric, rbf::Kernel::matern52}) {
    const rbf::Points<2> points = cube<2>(250, 8), targets = (0.9 * cube<2>(200, 9).array() + 0.05).matrix();
    const rbf::DivergenceFreeInterpolant<2> fit({kernel}, points, flow<2>(points));
    const double error = (fit.evaluate(targets) - flow<2>(targets)).norm() / flow<2>(targets).norm();
    EXPECT_LE(error, 0.04) << fit.report();  // measured: at most 0.024, of gaussian
    EXPECT_LE(error, 2 * fit.report().left_out[0] / fit.report().values[0]) << fit.report();
    EXPECT_TRUE(fit.report().shape_was_chosen);
  }
}

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const rbf::Error& error) {
    return error.what();
  }
  return "";
}

TEST(GeneralizedInterpolation, RefusesWhatItCannotDo) {
  rbf::Points<2> points = cube<2>(30, 10);
  const Eigen::VectorXd values = wave<2>(points);
  const Eigen::MatrixXd gradients = slopes<2>(points);
  const auto expect_in = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect_in(refusal([&] { rbf::HermiteInterpolant<2>({rbf::Kernel::thin_plate}, points, values, points, gradients); }),
            "thin-plate has no second derivatives at distance 0");
  expect_in(refusal([&] { rbf::DivergenceFreeInterpolant<2>({rbf::Kernel::thin_plate}, points, gradients); }),
            "thin-plate has no second derivatives at distance 0");
  expect_in(refusal([&] {
              rbf::DivergenceFreeInterpolant<2>({rbf::Kernel::gaussian, 5}, points, gradients);
            }),
            "Lower the shape");
  expect_in(refusal([&] { rbf::DivergenceFreeInterpolant<2>({rbf::Kernel::gaussian}, points, values); }),
            "vectors have 1 components");
  const rbf::Points<2> many = cube<2>(2001, 11);
  expect_in(refusal([&] { rbf::DivergenceFreeInterpolant<2>({rbf::Kernel::gaussian}, many, flow<2>(many)); }),
            "a dense fit to 4002 numbers was asked for");
  points.col(4) = points.col(9);
  expect_in(refusal([&] { rbf::DivergenceFreeInterpolant<2>({rbf::Kernel::gaussian}, points, gradients); }),
            "points 4 and 9 are both at (");
  expect_in(
      refusal([&] { rbf::HermiteInterpolant<2>({rbf::Kernel::gaussian}, cube<2>(30, 1), values, points, gradients); }),
      "slope points 4 and 9 are both at (");
  const rbf::HermiteInterpolant<2> fit({rbf::Kernel::gaussian}, cube<2>(30, 1), values, cube<2>(30, 1), gradients);
  expect_in(refusal([&] { fit.evaluate(points, {1, 1}); }), "at most 1 is possible");
}

}  // namespace
