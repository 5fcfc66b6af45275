// The promise of the methods that replace clusters: requested tolerance against achieved error, over clouds that are
// hard for them, charges of either sign, and leaves of few points, which make trees deep.
#include <gtest/gtest.h>

#include "farfield/clouds.hpp"
#include "farfield/farfield.hpp"
#include "farfield/naive.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;

// Rounding of sums of terms that differ by up to 1e8 in size, relative to the sum of their sizes.
constexpr double rounding = 1e-14;

template <int d>
struct Setting {
  std::string name;
  farfield::Points<d> sources, targets;
  bool self = true;
};

template <int d>
std::vector<Setting<d>> settings(Eigen::Index count, unsigned seed) {
  std::vector<Setting<d>> settings;
  for (const auto& cloud : clouds::all<d>(count, seed)) settings.push_back({cloud.name, cloud.points, cloud.points});
  return settings;
}

template <int d>
void expect_promise(Kernel kernel, const std::vector<Setting<d>>& settings, double core_radius = 0) {
  struct Case {
    const Setting<d>& setting;
    clouds::Charges charges;
    naive::Sums<d> exact;
  };
  std::vector<Case> cases;
  for (const auto& setting : settings)
    for (const clouds::Charges& charges : clouds::charges(setting.sources.cols(), 3))
      cases.push_back(
          {setting, charges, naive::sum<d>(kernel, setting.sources, setting.targets, charges.values, core_radius)});
  std::vector<farfield::Plan<d>> alive;  // plans of one tolerance share their tables as long as one of them lives
  for (const double tolerance : {1e-2, 1e-4, 1e-7})
    for (const bool self : {true, false}) {
      alive.clear();
      for (const Method method : {Method::symmetric, Method::tree})
        for (const std::size_t leaf_size : {std::size_t{4}, std::size_t{40}})
          for (const auto& setting : settings) {
            if (setting.self != self) continue;
            const farfield::Options options{.tolerance = tolerance,
                                            .method = method,
                                            .threads = 1,
                                            .core_radius = core_radius,
                                            .leaf_size = leaf_size};
            alive.push_back(self ? farfield::Plan<d>(kernel, setting.sources, options)
                                 : farfield::Plan<d>(kernel, setting.sources, setting.targets, options));
            const farfield::Plan<d>& plan = alive.back();
            EXPECT_EQ(plan.choice().method, method);
            EXPECT_LE(plan.choice().bound, tolerance);
            for (const Case& test : cases) {
              if (&test.setting != &setting) continue;
              const auto errors = naive::errors<d>(plan.evaluate(test.charges.values), test.exact);
              SCOPED_TRACE(testing::Message()
                           << setting.name << ", charges " << test.charges.name << ", " << plan.choice());
              EXPECT_LE(errors.field, tolerance + rounding);
              EXPECT_LE(errors.potential, tolerance + rounding);
            }
          }
    }
}

constexpr Eigen::Index count = 260;

TEST(FarfieldPromise, CoulombInSpace) { expect_promise<3>(Kernel::coulomb, settings<3>(count, 1)); }

TEST(FarfieldPromise, CoulombInThePlane) { expect_promise<2>(Kernel::coulomb, settings<2>(count, 2)); }

TEST(FarfieldPromise, LogarithmOnTheLine) { expect_promise<1>(Kernel::log, settings<1>(count, 3)); }

TEST(FarfieldPromise, VortexBlobs) {
  const farfield::Points<2> cube = naive::cube<2>(count, 4);
  for (const double core : {1e-9, 0.01, 0.3, 10.0})
    expect_promise<2>(Kernel::vortex_blob, {{"cube", cube, cube}}, core);
  expect_promise<2>(Kernel::vortex_blob, settings<2>(count, 5), 1e-3);
}

TEST(FarfieldPromise, TargetsElsewhere) {
  const auto sources = clouds::all<3>(count, 6), targets = clouds::all<3>(300, 7);
  std::vector<Setting<3>> mixed;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto& other = targets[(i + 1) % targets.size()];
    mixed.push_back({sources[i].name + " at " + other.name, sources[i].points, other.points, false});
  }
  expect_promise<3>(Kernel::coulomb, mixed);
}

// Sources in one corner of a cluster, targets in the facing corner of another: the largest error of the table, and no
// neighbours that would see it exactly.
TEST(FarfieldPromise, SourcesAndTargetsInFacingCorners) {
  farfield::Points<3> sources = naive::cube<3>(count, 8, 0.24, 0.25), targets = naive::cube<3>(count, 9, 0.5, 0.51);
  sources.col(0) << 0, 0, 0;
  targets.col(0) << 0.99999, 0.99999, 0.99999;
  expect_promise<3>(Kernel::coulomb, {{"facing corners", sources, targets, false}});
  expect_promise<2>(Kernel::log, {{"facing corners", sources.topRows(2), targets.topRows(2), false}});
}

TEST(FarfieldPromise, OneTwoAndThreePoints) {
  std::vector<Setting<3>> all;
  for (const Eigen::Index few : {1, 2, 3})
    for (const auto& setting : settings<3>(few, 10)) all.push_back(setting);
  expect_promise<3>(Kernel::coulomb, all);
}

// Single precision leaves pairs that are close beside the leaf to double, and a point's pair with itself alone.
TEST(FarfieldPromise, PairsHoweverClose) {
  naive::Points<3> points = naive::cube<3>(count, 11);
  std::vector<Setting<3>> all;
  for (const double close : {1e-3, 1e-6, 1e-12, 1e-17, 1e-30}) {
    points.col(7) << 0, 0, 0;
    points.col(12) << close, -2 * close, 0;
    points.col(13) = points.col(20);
    all.push_back({"close pairs", points, points});
  }
  expect_promise<3>(Kernel::coulomb, all);
}

TEST(FarfieldPromise, HoldsForAnyUnitOfLengthAndCharge) {
  for (const double length : {1e-60, 1e60}) {
    const naive::Points<3> points = length * naive::cube<3>(count, 12);
    const naive::Points<2> plane = points.topRows(2);
    const Eigen::VectorXd charges = naive::charges(count, 13) * 1e40;
    const farfield::Plan<3> space(Kernel::coulomb, points,
                                  {.tolerance = 1e-4, .method = Method::symmetric, .leaf_size = 8});
    const auto errors =
        naive::errors<3>(space.evaluate(charges), naive::sum<3>(Kernel::coulomb, points, points, charges));
    EXPECT_LE(std::max(errors.field, errors.potential), 1e-4);
    const farfield::Plan<2> flat(Kernel::coulomb, plane,
                                 {.tolerance = 1e-4, .method = Method::symmetric, .leaf_size = 8});
    const auto flat_errors =
        naive::errors<2>(flat.evaluate(charges), naive::sum<2>(Kernel::coulomb, plane, plane, charges));
    EXPECT_LE(std::max(flat_errors.field, flat_errors.potential), 1e-4);
  }
}

}  // namespace
