// What an evaluation does, counted: linear in the number of points by symmetric, and every pair by direct. Counts are
// the same on every machine; seconds are not.
#include <gtest/gtest.h>

#include <cmath>

#include "farfield/farfield.hpp"
#include "farfield/naive.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;
using farfield::Work;

template <int d>
Work work(Kernel kernel, Method method, Eigen::Index count) {
  const farfield::Points<d> points = naive::cube<d>(count, 1);
  return farfield::Plan<d>(kernel, points, {.tolerance = 1e-3, .method = method, .leaf_size = 40}).choice().work;
}

double a_doubling(double few, double many, double doublings) { return std::pow(many / few, 1 / doublings); }

// Three doublings of N in space and two in the plane put as many points into the leaves as before. Below 2 because the
// leaves stay equal, above because clusters at the faces of the cube, which have fewer neighbours, are a smaller part.
template <int d>
void expect_linear(Kernel kernel, Eigen::Index count) {
  const Work few = work<d>(kernel, Method::symmetric, count), many = work<d>(kernel, Method::symmetric, count << d);
  for (const auto& [part, name] : {std::pair{&Work::pairs, "pairs"}, {&Work::couplings, "couplings"}}) {
    ASSERT_GT(few.*part, 0) << name;
    const double growth = a_doubling(few.*part, many.*part, d);
    EXPECT_GT(growth, 1.9) << name;
    EXPECT_LT(growth, 2.2) << name;
  }
  EXPECT_LE(many.substitute_pairs, 0.02 * many.pairs);  // only where neighbouring leaves differ in size
}

TEST(Work, OfSymmetricDoublesWithThePointsInSpace) { expect_linear<3>(Kernel::coulomb, 20'000); }
TEST(Work, OfSymmetricDoublesWithThePointsInThePlane) { expect_linear<2>(Kernel::log, 20'000); }

TEST(Work, OfTreeGrowsFasterThanThePoints) {
  const auto a_point = [](Eigen::Index count) {
    const Work found = work<3>(Kernel::coulomb, Method::tree, count);
    EXPECT_EQ(found.couplings, 0);
    return (found.pairs + found.substitute_pairs) / static_cast<double>(count);
  };
  const double few = a_point(2'500), more = a_point(20'000), many = a_point(160'000);
  EXPECT_GT(more, 1.1 * few);  // with every level of the tree a target sees more clusters: N log N
  EXPECT_GT(many, 1.1 * more);
}

TEST(Work, OfDirectIsEveryPair) {
  EXPECT_EQ(work<3>(Kernel::coulomb, Method::direct, 300).pairs, 90'000);
  EXPECT_EQ(work<2>(Kernel::log, Method::direct, 300).couplings, 0);
}

// One side alone is interpolated where a leaf meets a much smaller one, so pairs of points are never more than all.
TEST(Work, IsNeverMoreThanEveryPairOfPoints) {
  const farfield::Points<3> points = naive::plummer<3>(20'000, 2);
  for (const Method method : {Method::tree, Method::symmetric}) {
    const farfield::Plan<3> plan(Kernel::coulomb, points, {.tolerance = 1e-3, .method = method});
    EXPECT_GT(plan.choice().work.pairs, 0);
    EXPECT_LT(plan.choice().work.pairs, 4e8);
  }
}

TEST(Seconds, AreOfThePartsThatAMethodHas) {
  const farfield::Points<3> points = naive::cube<3>(3'000, 3);
  const Eigen::VectorXd charges = Eigen::VectorXd::Ones(3'000);
  const auto seconds = [&](Method method) {
    farfield::Seconds parts;
    const farfield::Plan<3> plan(Kernel::coulomb, points, {.tolerance = 1e-3, .method = method, .leaf_size = 40});
    EXPECT_EQ(plan.evaluate(charges, &parts).field, plan.evaluate(charges).field);
    return parts;
  };
  const farfield::Seconds direct = seconds(Method::direct), tree = seconds(Method::tree),
                          symmetric = seconds(Method::symmetric);
  EXPECT_EQ(direct.forward + direct.coupling + direct.backward, 0);
  EXPECT_EQ(tree.coupling + tree.backward, 0);
  for (const double part : {direct.leaves, tree.forward, tree.leaves, symmetric.forward, symmetric.coupling,
                            symmetric.backward, symmetric.leaves})
    EXPECT_GT(part, 0);
}

}  // namespace
