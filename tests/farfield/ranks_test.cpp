// Points on several ranks give the bits of all points on one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "farfield/clouds.hpp"
#include "farfield/farfield.hpp"
#include "farfield/naive.hpp"
#include "farfield/ranks.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;
using farfield::Options;
using farfield::Points;
using farfield::Values;

/// Which points a rank has.
enum class Spread { lines, halves, first_has_all };

std::vector<Eigen::Index> points_of(Spread spread, Eigen::Index count, int rank, int ranks) {
  std::vector<Eigen::Index> some;
  for (Eigen::Index j = 0; j < count; ++j) {
    const bool mine = spread == Spread::lines    ? j % ranks == rank
                      : spread == Spread::halves ? j * ranks / count == rank
                                                 : rank == 0;
    if (mine) some.push_back(j);
  }
  std::shuffle(some.begin(), some.end(), std::mt19937(7));
  return some;
}

/// A rank's points of all, with numbers that are not 0, 1, 2 ...
template <int d>
struct Share {
  std::vector<Eigen::Index> columns;
  Points<d> points;
  std::vector<std::int64_t> numbers;

  Share(const Points<d>& all, Spread spread, const farfield::Ranks& ranks)
      : columns(points_of(spread, all.cols(), ranks.rank(), ranks.size())),
        points(d, static_cast<Eigen::Index>(columns.size())) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      points.col(static_cast<Eigen::Index>(i)) = all.col(columns[i]);
      numbers.push_back(3 * columns[i] - 1000);
    }
  }
  Eigen::VectorXd of(const Eigen::VectorXd& charges) const {
    Eigen::VectorXd own(points.cols());
    for (std::size_t i = 0; i < columns.size(); ++i) own[static_cast<Eigen::Index>(i)] = charges[columns[i]];
    return own;
  }
};

template <int d>
struct OnRanks {
  Values<d> values;
  farfield::Choice choice;
};

/// Checks on the way that each rank knows what it receives.
template <int d>
OnRanks<d> evaluate(Kernel kernel, const Points<d>& points, const Eigen::VectorXd& charges, const Options& options,
                    int size, Spread spread) {
  const bool potential = options.potential && kernel != Kernel::vortex_blob;
  OnRanks<d> all{{Eigen::VectorXd(potential ? points.cols() : 0), Points<d>(d, points.cols())}, {}};
  test::on_ranks(size, [&](test::RankThread& ranks) {
    const Share<d> own(points, spread, ranks);
    const farfield::Plan<d> plan(kernel, own.points, own.numbers, options, ranks);
    const Values<d> values = plan.evaluate(own.of(charges));
    const farfield::Received received = plan.received();
    EXPECT_EQ(received.points + received.tree + received.moments + received.near, ranks.received());
    EXPECT_EQ(plan.evaluate(own.of(charges)).field, values.field) << "once more";
    for (std::size_t i = 0; i < own.columns.size(); ++i) {  // every rank writes other columns
      if (potential) all.values.potential[own.columns[i]] = values.potential[static_cast<Eigen::Index>(i)];
      all.values.field.col(own.columns[i]) = values.field.col(static_cast<Eigen::Index>(i));
    }
    if (ranks.rank() == size - 1) all.choice = plan.choice();
  });
  return all;
}

template <class Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

template <int d>
void expect_same_bits(Kernel kernel, const Points<d>& points, const Options& options, const std::string& what,
                      const std::vector<int>& sizes, Spread spread = Spread::lines) {
  const Eigen::VectorXd charges = naive::charges(points.cols(), 3);
  const farfield::Plan<d> plan(kernel, points, options);
  const farfield::Choice& choice = plan.choice();
  const auto one = plan.evaluate(charges);
  for (const int size : sizes) {
    SCOPED_TRACE(what + " on " + std::to_string(size) + " ranks");
    const auto several = evaluate<d>(kernel, points, charges, options, size, spread);
    EXPECT_EQ(several.choice.method, choice.method);
    EXPECT_EQ(several.choice.leaf_size, choice.leaf_size);
    EXPECT_EQ(several.choice.clusters, choice.clusters);
    EXPECT_EQ(several.choice.levels, choice.levels);
    EXPECT_EQ(several.choice.seconds, choice.seconds);
    EXPECT_EQ(several.choice.sources, choice.sources);
    EXPECT_EQ(several.choice.work.pairs, choice.work.pairs);
    EXPECT_EQ(several.choice.work.substitute_pairs, choice.work.substitute_pairs);
    EXPECT_EQ(several.choice.work.couplings, choice.work.couplings);
    EXPECT_TRUE(same_bits(several.values.potential, one.potential));
    EXPECT_TRUE(same_bits(several.values.field, one.field));
  }
}

const std::vector<int> all_numbers{1, 2, 3, 4, 8};

// Clusters of all ranks meet at the borders, leaves of all sizes among them.
TEST(FarfieldRanks, HaveTheBitsOfOneForHardClouds) {
  for (const Method method : {Method::symmetric, Method::tree, Method::direct}) {
    const Options in_space{.tolerance = 1e-4, .method = method, .threads = 1, .leaf_size = 20},
        in_plane{.tolerance = 1e-6, .method = method, .threads = 1, .leaf_size = 12},
        blobs{.tolerance = 1e-5, .method = method, .threads = 1, .core_radius = 0.01, .leaf_size = 12};
    for (const auto& cloud : clouds::all<3>(800, 1))
      expect_same_bits<3>(Kernel::coulomb, cloud.points, in_space, cloud.name + " by " + to_string(method), {3});
    for (const auto& cloud : clouds::all<2>(800, 1)) {
      expect_same_bits<2>(Kernel::log, cloud.points, in_plane, cloud.name + " by " + to_string(method), {3});
      expect_same_bits<2>(Kernel::vortex_blob, cloud.points, blobs, cloud.name + ", blobs by " + to_string(method),
                          {3});
    }
    const Points<1> line = naive::cube<1>(500, 4);
    expect_same_bits<1>(Kernel::log, line, in_plane, "line by " + to_string(method), {3});
  }
}

TEST(FarfieldRanks, HaveTheBitsOfOneForAnyNumber) {
  const auto cube = naive::cube<3>(2000, 2), sphere = naive::plummer<3>(2000, 2);
  const auto square = naive::cube<2>(2000, 2), disk = naive::plummer<2>(2000, 2);
  const Options in_space{.tolerance = 1e-5, .method = Method::symmetric, .threads = 1, .leaf_size = 30},
      in_plane{.tolerance = 1e-9, .method = Method::symmetric, .threads = 1, .leaf_size = 16},
      blobs{.tolerance = 1e-4, .method = Method::symmetric, .threads = 1, .core_radius = 0.003, .leaf_size = 16};
  for (const Spread spread : {Spread::halves, Spread::first_has_all}) {
    expect_same_bits<3>(Kernel::coulomb, cube, in_space, "cube", {4}, spread);
    expect_same_bits<2>(Kernel::vortex_blob, square, blobs, "blobs", {3}, spread);
  }
  expect_same_bits<3>(Kernel::coulomb, cube, in_space, "cube", all_numbers);
  expect_same_bits<2>(Kernel::vortex_blob, square, blobs, "blobs", all_numbers);
  expect_same_bits<3>(Kernel::coulomb, sphere, in_space, "sphere", all_numbers);
  expect_same_bits<2>(Kernel::log, square, in_plane, "square", all_numbers);
  expect_same_bits<2>(Kernel::coulomb, disk, in_plane, "disk", all_numbers);
}

// Method and leaf size follow from samples of all ranks' clusters; leaves are larger than those that were counted.
TEST(FarfieldRanks, ChooseTogetherAsOneDoes) {
  for (const Method method : {Method::automatic, Method::symmetric, Method::tree}) {
    expect_same_bits<3>(Kernel::coulomb, naive::plummer<3>(20'000, 5),
                        {.tolerance = 1e-2, .method = method, .threads = 1}, "sphere by " + to_string(method), {3});
    expect_same_bits<2>(Kernel::log, naive::cube<2>(40'000, 5), {.tolerance = 1e-4, .method = method, .threads = 1},
                        "square by " + to_string(method), {4});
  }
}

TEST(FarfieldRanks, MayHaveFewPointsOrNone) {
  for (const Method method : {Method::automatic, Method::symmetric, Method::tree, Method::direct})
    for (const Eigen::Index count : {0, 1, 2, 5, 40}) {
      const Options options{.tolerance = 1e-4, .method = method, .threads = 1, .leaf_size = 4};
      const std::string what = std::to_string(count) + " points by " + to_string(method);
      expect_same_bits<3>(Kernel::coulomb, naive::cube<3>(count, 2), options, what, {1, 4, 8});
      expect_same_bits<3>(Kernel::coulomb, Points<3>::Constant(3, count, 0.7), options, what + " in one place", {3});
    }
}

/// What each of three ranks throws where `spoil` changes the share of one rank.
template <class Wanted, class Spoil>
void expect_thrown_by_all(const std::string& words, const Spoil& spoil) {
  const Points<3> points = naive::cube<3>(300, 3);
  const Eigen::VectorXd charges = naive::charges(300, 4);
  const auto ends = test::ends_on_ranks(3, [&](test::RankThread& ranks) {
    Share<3> own(points, Spread::lines, ranks);
    Eigen::VectorXd weights = own.of(charges);
    Options options{.tolerance = 1e-4, .method = Method::symmetric, .threads = 1, .leaf_size = 20};
    if (ranks.rank() > 0) spoil(own, weights, options);
    farfield::Plan<3>(Kernel::coulomb, own.points, own.numbers, options, ranks).evaluate(weights);
  });
  for (const auto& end : ends) {
    ASSERT_TRUE(end) << words;
    try {
      std::rethrow_exception(end);
    } catch (const Wanted& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

TEST(FarfieldRanks, ThrowTogether) {
  using Weights = Eigen::VectorXd;
  expect_thrown_by_all<farfield::InvalidArgument>(
      "of the point with the number -", [](Share<3>& own, Weights&, Options&) { own.points(1, 5) = std::nan(""); });
  expect_thrown_by_all<farfield::InvalidArgument>("charge 7",
                                                  [](Share<3>&, Weights& charges, Options&) { charges[7] = HUGE_VAL; });
  expect_thrown_by_all<farfield::InvalidArgument>("two points have the number 17",
                                                  [](Share<3>& own, Weights&, Options& options) {
                                                    std::fill(own.numbers.begin(), own.numbers.begin() + 90, 17);
                                                    options.memory_limit += 1;
                                                  });
  expect_thrown_by_all<farfield::InvalidArgument>("99 numbers for 100 points",
                                                  [](Share<3>& own, Weights&, Options&) { own.numbers.pop_back(); });
  expect_thrown_by_all<farfield::MemoryLimitError>(
      "would need", [](Share<3>&, Weights&, Options& options) { options.memory_limit = 20'000; });
  expect_thrown_by_all<farfield::RangeError>("at target -", [](Share<3>& own, Weights& charges, Options&) {
    charges.setConstant(1e300);
    own.points.col(1) = own.points.col(0) + Eigen::Vector3d(1e-200, 0, 0);
    own.points.col(0).setZero();
    own.points.col(1) << 1e-100, 0, 0;
  });
}

// Four ranks have two octants of the cube each, 8 x 8 x 16 leaves. Clusters are coupled up to two beyond such a block, and
// leaves have their neighbours beside them. The counts are those of the plan: nothing is summed.
TEST(FarfieldRanks, ReceiveWhatTheModelSays) {
  constexpr double leaves = 16 * 16 * 16, points = 1'000'000, ranks_of_all = 4;
  const Points<3> cube = naive::cube<3>(static_cast<Eigen::Index>(points), 6);
  const double coupled = (10 * 10 - 8 * 8) * 16 + (6 * 6 - 4 * 4) * 8 + (4 * 4 - 2 * 2) * 4,
               beside = (9 * 9 - 8 * 8) * 16;
  // The model of a rank inside many others, for large numbers of them.
  const auto shell = [](double side, double thickness) { return std::pow(side + thickness, 3) - std::pow(side, 3); };
  const double side = std::cbrt(leaves / ranks_of_all);
  double clusters = 189 * (1 + std::log(ranks_of_all) / std::log(8));
  for (double s = side; s > 1; s /= 2) clusters += shell(s, 4);
  test::on_ranks(static_cast<int>(ranks_of_all), [&](test::RankThread& ranks) {
    const Share<3> mine(cube, Spread::halves, ranks);
    const farfield::Plan<3> plan(Kernel::coulomb, mine.points, mine.numbers, {.tolerance = 3e-4, .threads = 1}, ranks);
    ASSERT_EQ(plan.choice().clusters, 1 + 8 + 64 + 512 + leaves);
    const double functions = std::pow(plan.choice().degree + 1, 2), bytes_of_point = 4 * sizeof(double),
                 moments = 1.25 * clusters * functions * sizeof(double),
                 near = 1.1 * points / leaves * shell(side, 2) * bytes_of_point;
    const farfield::Received received = plan.received();
    EXPECT_LT(received.moments + received.near + received.tree, 1.3 * (moments + near));
    EXPECT_EQ(received.moments, coupled * functions * sizeof(double));
    EXPECT_NEAR(received.near, beside * points / leaves * bytes_of_point, 0.02 * received.near);
    EXPECT_LT(received.tree, 0.1 * received.near);
    // Three of four points are summed for elsewhere: place, number and charge go there, potential and field come back.
    EXPECT_NEAR(received.points, 0.75 * points / ranks_of_all * 9 * sizeof(double), 0.02 * received.points);
  });
}

}  // namespace
