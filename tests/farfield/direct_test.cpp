// `direct` against the definition in long double.
#include <gtest/gtest.h>

#include "farfield/farfield.hpp"
#include "farfield/naive.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;

// Rounding of a term, relative to it: coordinates, square root, powers, products, seven at 1.1e-16. 64 terms of random
// sign add little. Measured 2.6e-16.
constexpr double rounding_of_a_sum = 7.7e-16;

template <int d>
void expect_exact(Kernel kernel, const naive::Points<d>& sources, const naive::Points<d>& targets,
                  const Eigen::VectorXd& charges, double core_radius = 0) {
  const farfield::Options options{.method = Method::direct, .core_radius = core_radius};
  const farfield::Plan<d> plan(kernel, sources, targets, options);
  const auto errors =
      naive::errors<d>(plan.evaluate(charges), naive::sum<d>(kernel, sources, targets, charges, core_radius));
  EXPECT_LE(errors.potential, rounding_of_a_sum) << to_string(kernel) << " " << d << "D";
  EXPECT_LE(errors.field, rounding_of_a_sum) << to_string(kernel) << " " << d << "D";
}

TEST(FarfieldDirect, EqualsTheDefinition) {
  for (const Eigen::Index count : {1, 2, 3, 7, 16, 61, 700}) {
    const auto q = naive::charges(count, 1);
    expect_exact<3>(Kernel::coulomb, naive::cube<3>(count, 2), naive::cube<3>(53, 3, -1, 1.5), q);
    expect_exact<2>(Kernel::coulomb, naive::cube<2>(count, 2), naive::cube<2>(53, 3, -1, 1.5), q);
    expect_exact<2>(Kernel::log, naive::cube<2>(count, 2), naive::cube<2>(53, 3, -1, 1.5), q);
    expect_exact<1>(Kernel::log, naive::cube<1>(count, 2), naive::cube<1>(53, 3, -1, 1.5), q);
    for (const double core : {1e-6, 0.03, 0.4, 30.0})
      expect_exact<2>(Kernel::vortex_blob, naive::cube<2>(count, 2), naive::cube<2>(53, 3, -1, 1.5), q, core);
  }
}

TEST(FarfieldDirect, LeavesOutPairsAtDistanceZeroAlone) {
  const auto points = naive::cube<3>(40, 4);
  naive::Points<3> doubled(3, 80);
  doubled << points, points;
  expect_exact<3>(Kernel::coulomb, doubled, doubled, naive::charges(80, 5));
  expect_exact<2>(Kernel::log, naive::Points<2>(doubled.topRows(2)), naive::Points<2>(doubled.topRows(2)),
                  naive::charges(80, 5));
  const farfield::Plan<3> alone(Kernel::coulomb, points.leftCols(1), {.method = Method::direct});
  EXPECT_EQ(alone.evaluate(Eigen::VectorXd::Ones(1)).field.norm(), 0);
  EXPECT_EQ(alone.evaluate(Eigen::VectorXd::Ones(1)).potential.norm(), 0);
}

TEST(FarfieldDirect, TwoChargesAttractAsCoulombSays) {
  naive::Points<3> points(3, 2);
  points << 1, 1, 2, 2, 3, 5;
  const farfield::Plan<3> plan(Kernel::coulomb, points);
  const auto values = plan.evaluate(Eigen::Vector2d(3, -4));
  EXPECT_DOUBLE_EQ(values.potential[0], -4.0 / 2);
  EXPECT_DOUBLE_EQ(values.field(2, 0), 4.0 / 4);  // q (x - y) / r^3 = -4 (-2) / 8
  EXPECT_DOUBLE_EQ(values.field(2, 1), 3.0 / 4);
}

// Around a vortex of circulation 2 pi the speed is 1/r outside its core, and r / eps^2 well inside.
TEST(FarfieldDirect, AVortexBlobTurnsCounterclockwise) {
  const naive::Points<2> centre = naive::Points<2>::Zero(2, 1);
  naive::Points<2> targets(2, 2);
  targets << 2, 1e-4, 0, 0;
  const farfield::Plan<2> plan(Kernel::vortex_blob, centre, targets, {.core_radius = 0.1});
  const auto values = plan.evaluate(Eigen::VectorXd::Constant(1, 2 * 3.14159265358979323846));
  EXPECT_NEAR(values.field(1, 0), 0.5, 1e-15);
  EXPECT_NEAR(values.field(1, 1), 1e-2, 1e-8);  // 1e-8: next term of the series, r^2 / (2 eps^2) = 5e-7
  EXPECT_EQ(values.field(0, 0), 0);
  EXPECT_EQ(values.potential.size(), 0);
}

// Distances of 1e-30 and of 1e-200 in a cloud of 1 have squares that float and double do not hold.
TEST(FarfieldDirect, SeesPairsHoweverClose) {
  for (const double close : {1e-17, 1e-19, 1e-30, 1e-120}) {
    naive::Points<3> points = naive::cube<3>(20, 6);
    points.col(7) << 0, 0, 0;
    points.col(12) << close, -2 * close, 0;
    expect_exact<3>(Kernel::coulomb, points, points, naive::charges(20, 7));
    const naive::Points<2> plane = points.topRows(2);
    expect_exact<2>(Kernel::coulomb, plane, plane, naive::charges(20, 7));
  }
  naive::Points<2> two(2, 3);
  two << 0, 1e-200, 1, 0, 0, 1;
  expect_exact<2>(Kernel::log, two, two, naive::charges(3, 7));
}

TEST(FarfieldDirect, HoldsForAnyUnitOfLengthAndCharge) {
  for (const double length : {1e-90, 1e-20, 1e20, 1e90})
    for (const double unit : {1e-90, 1e90}) {
      const naive::Points<3> points = length * naive::cube<3>(20, 8);
      expect_exact<3>(Kernel::coulomb, points, points, unit * naive::charges(20, 9));
      const naive::Points<2> plane = length * naive::cube<2>(20, 8);
      expect_exact<2>(Kernel::log, plane, plane, unit * naive::charges(20, 9));
      expect_exact<2>(Kernel::vortex_blob, plane, plane, unit * naive::charges(20, 9), 0.1 * length);
    }
}

TEST(FarfieldDirect, TheFieldAloneIsTheSameField) {
  const auto points = naive::cube<2>(90, 10);
  const auto q = naive::charges(90, 11);
  const farfield::Plan<2> both(Kernel::log, points), field(Kernel::log, points, {.potential = false});
  EXPECT_EQ(field.evaluate(q).field, both.evaluate(q).field);
  EXPECT_EQ(field.evaluate(q).potential.size(), 0);
}

TEST(FarfieldDirect, NoSourcesOrNoTargets) {
  const naive::Points<3> none(3, 0);
  const auto some = naive::cube<3>(5, 12);
  const farfield::Plan<3> no_sources(Kernel::coulomb, none, some), no_targets(Kernel::coulomb, some, none);
  EXPECT_EQ(no_sources.evaluate(Eigen::VectorXd(0)).potential, Eigen::VectorXd::Zero(5));
  EXPECT_EQ(no_targets.evaluate(Eigen::VectorXd::Ones(5)).field.cols(), 0);
}

}  // namespace
