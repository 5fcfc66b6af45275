// Periodic boxes, boxes between mirrors, and single mirrors: sums of all copies against Ewald's sum and sums of rows that
// are written out in lattice.hpp, and against constants that are known.
#include <gtest/gtest.h>

#include <cmath>

#include "farfield/lattice.hpp"
#include "farfield/naive.hpp"
#include "message_of.hpp"

namespace {

using farfield::Ends;
using farfield::Kernel;
using farfield::MirrorImages;
using farfield::Options;
using farfield::Points;

/// Points of a box with corners at low and low + length.
template <int d>
Points<d> points_in(const Options& options, Eigen::Index count, unsigned seed) {
  Points<d> points = naive::cube<d>(count, seed);
  for (int l = 0; l < d; ++l) {
    const farfield::Axis& axis = options.axes[static_cast<std::size_t>(l)];
    const double low = axis.ends == Ends::unbounded ? -0.4 : axis.low,
                 length = axis.ends == Ends::unbounded ? 1.7 : axis.high - axis.low;
    points.row(l) = points.row(l).array() * length + low;
  }
  return points;
}

Options box(const std::vector<farfield::Axis>& axes, double tolerance, MirrorImages images = MirrorImages::equal) {
  Options options{.tolerance = tolerance, .threads = 1, .mirror_images = images};
  std::copy(axes.begin(), axes.end(), options.axes.begin());
  return options;
}

/// Rounding of sums of terms as large as those that the promise is relative to.
constexpr double rounding = 2e-14;

template <int d>
farfield::Plan<d> expect_promise(Kernel kernel, const Options& options, const Points<d>& sources,
                                 const Points<d>& targets, const lattice::Sums<d>& exact,
                                 const Eigen::VectorXd& charges) {
  farfield::Plan<d> plan(kernel, sources, targets, options);
  const farfield::Values<d> values = plan.evaluate(charges);
  SCOPED_TRACE(testing::Message() << plan.choice() << ", " << plan.choice().copies << " copies, rest of degree "
                                  << plan.choice().rest_degree);
  EXPECT_EQ(plan.choice().sources, static_cast<std::size_t>(sources.cols()));
  EXPECT_LE(plan.choice().bound, options.tolerance);
  for (Eigen::Index i = 0; i < targets.cols(); ++i) {
    EXPECT_LE((values.field.col(i) - exact.field.col(i)).norm(), (options.tolerance + rounding) * exact.field_scale[i]);
    if (kernel == Kernel::vortex_blob) continue;
    const double sign = kernel == Kernel::log ? -1 : 1;
    EXPECT_LE(std::abs(values.potential[i] - sign * exact.potential[i]),
              (options.tolerance + rounding) * exact.potential_scale[i]);
  }
  return plan;
}

struct Setting {
  const char* name;
  std::vector<farfield::Axis> axes;
  MirrorImages images = MirrorImages::equal;
};

template <int d>
void expect_sums(Kernel kernel, const std::vector<Setting>& settings, const std::vector<double>& tolerances,
                 double core_radius = 0) {
  constexpr Eigen::Index count = d == 3 ? 25 : 60;
  for (const Setting& setting : settings) {
    Options options = box(setting.axes, 1, setting.images);
    options.core_radius = core_radius;
    const Points<d> sources = points_in<d>(options, count, 3), other = points_in<d>(options, 12, 4);
    Points<d> targets(d, 16);
    targets << sources.leftCols(4), other;
    const Eigen::VectorXd charges = naive::charges(count, 5, -0.5, 1);
    const lattice::Sums<d> exact = lattice::sum<d>(options, sources, targets, charges);
    std::vector<farfield::Plan<d>> alive;  // the next plan takes the rest of its box from it
    for (const double tolerance : tolerances)
      for (const farfield::Method method : {farfield::Method::direct, farfield::Method::symmetric}) {
        SCOPED_TRACE(testing::Message() << setting.name << ", " << tolerance);
        options.tolerance = tolerance;
        options.method = method;
        options.leaf_size = method == farfield::Method::direct ? 0 : 20;
        if (method == farfield::Method::symmetric && tolerance < 1e-7) continue;
        alive.push_back(expect_promise<d>(kernel, options, sources, targets, exact, charges));
      }
  }
}

TEST(FarfieldCopies, MadelungsConstants) {
  Points<3> salt(3, 8);
  Eigen::VectorXd charges(8);
  for (int i = 0; i < 8; ++i) {
    salt.col(i) << (i & 1) * 0.5, (i >> 1 & 1) * 0.5, (i >> 2 & 1) * 0.5;
    charges[i] = salt.col(i).sum() == std::floor(salt.col(i).sum()) ? 1 : -1;
  }
  const Options cube = box({{Ends::periodic, 0, 1}, {Ends::periodic, 0, 1}, {Ends::periodic, 0, 1}}, 1e-9);
  const farfield::Values<3> sodium = farfield::Plan<3>(Kernel::coulomb, salt, cube).evaluate(charges);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(-charges[i] * sodium.potential[i] / 2, 1.7475645946331822, 1e-12);
  EXPECT_LT(sodium.field.norm(), 1e-11);
  Points<3> caesium(3, 2);
  caesium << 0.1, 0.6, 0.2, 0.7, 0.3, 0.8;
  const farfield::Values<3> chloride =
      farfield::Plan<3>(Kernel::coulomb, caesium, cube).evaluate(Eigen::Vector2d(1, -1));
  EXPECT_NEAR(-chloride.potential[0] * std::sqrt(3) / 2, 1.7626747730709883, 1e-12);
  // A charge alone, with its background: Wigner's crystal.
  const Points<3> one = caesium.leftCols(1);
  const farfield::Values<3> wigner =
      farfield::Plan<3>(Kernel::coulomb, one, cube).evaluate(Eigen::VectorXd::Constant(1, 1));
  EXPECT_NEAR(wigner.potential[0], -2.837297479480620, 1e-11);
}

TEST(FarfieldCopies, ChargesInSpace) {
  const Ends p = Ends::periodic, m = Ends::mirrors;
  expect_sums<3>(Kernel::coulomb,
                 {{"cube", {{p, 0, 1}, {p, 0, 1}, {p, 0, 1}}},
                  {"brick", {{p, -2, -0.6}, {p, 100, 101}, {p, 0, 1.2}}},
                  {"room", {{m, 0, 1}, {m, 0, 1.1}, {m, 3, 4}}},
                  {"earthed plates", {{p, 0, 1}, {m, 0, 0.9}, {p, 3, 4}}, MirrorImages::opposite}},
                 {1e-3, 1e-6});
  expect_sums<3>(Kernel::coulomb, {{"cube", {{p, 0, 1}, {p, 0, 1}, {p, 0, 1}}}}, {1e-11});
}

TEST(FarfieldCopies, ChargesInThePlane) {
  const Ends p = Ends::periodic, m = Ends::mirrors, none = Ends::unbounded;
  const std::vector<Setting> settings{{"square", {{p, 0, 1}, {p, 0, 1}}},
                                      {"far away", {{p, 1000, 1002}, {p, -3, 0}}},
                                      {"long", {{p, 0, 7}, {p, 0, 1}}},
                                      {"channel", {{p, 0, 1}, {m, -1, 0.5}}},
                                      {"room", {{m, 0, 1}, {m, 0, 2}}},
                                      {"earthed", {{m, 0, 1}, {m, 0, 1}}, MirrorImages::opposite},
                                      {"strip", {{p, -1, 0.5}, {none}}},
                                      {"between mirrors", {{m, -1, 0.5}, {none}}},
                                      {"between plates", {{m, -1, 0.5}, {none}}, MirrorImages::opposite}};
  expect_sums<2>(Kernel::coulomb, settings, {1e-3, 1e-6, 1e-11});
  expect_sums<2>(Kernel::log, {settings[1], settings[3], settings[7]}, {1e-6});
}

TEST(FarfieldCopies, Vortices) {
  const Ends p = Ends::periodic, m = Ends::mirrors, none = Ends::unbounded;
  expect_sums<2>(Kernel::vortex_blob,
                 {{"square", {{p, 0, 1}, {p, 0, 1}}},
                  {"room", {{m, 0, 1}, {m, 0, 2}}, MirrorImages::opposite},
                  {"channel", {{p, 0, 2}, {m, 0, 1}}, MirrorImages::opposite},
                  {"row", {{p, 0, 1}, {none}}},
                  {"charges with cores", {{m, 0, 1}, {p, 0, 2}}}},
                 {1e-4, 1e-9}, 0.08);
}

// The images of a mirror and of a corner are few, and written down one by one.
TEST(FarfieldCopies, MirrorsAtOneEnd) {
  for (const MirrorImages images : {MirrorImages::equal, MirrorImages::opposite}) {
    const double turn = images == MirrorImages::opposite ? -1 : 1;
    const Options options =
        box({{Ends::mirror_low, -0.4}, {Ends::unbounded}, {Ends::mirror_high, 0, 1.5}}, 1e-6, images);
    const Points<3> points = naive::cube<3>(300, 7);
    const Eigen::VectorXd charges = naive::charges(300, 8);
    Points<3> all(3, 1200);
    Eigen::VectorXd all_charges(1200);
    for (int c = 0; c < 4; ++c) {
      Points<3> image = points;
      if (c & 1) image.row(0) = -0.8 - image.row(0).array();
      if (c & 2) image.row(2) = 3 - image.row(2).array();
      all.middleCols(300 * c, 300) = image;
      all_charges.segment(300 * c, 300) = charges * (c == 1 || c == 2 ? turn : 1);
    }
    const naive::Sums<3> exact = naive::sum<3>(Kernel::coulomb, all, points, all_charges);
    const farfield::Plan<3> plan(Kernel::coulomb, points, options);
    EXPECT_EQ(plan.choice().copies, 4u);
    EXPECT_EQ(plan.choice().rest_degree, 0);
    const farfield::Values<3> values = plan.evaluate(charges);
    for (Eigen::Index i = 0; i < 300; ++i) {
      EXPECT_LE((values.field.col(i) - exact.field.col(i)).norm(), 1e-6 * exact.field_scale[i]);
      EXPECT_LE(std::abs(values.potential[i] - exact.potential[i]), 1e-6 * exact.potential_scale[i]);
    }
  }
}

// A row of equal vortices: Lamb's formula for its velocity. [Lam32], article 156
TEST(FarfieldCopies, ARowOfVorticesAndItsShear) {
  Options options = box({{Ends::periodic, 0, 1}, {Ends::unbounded}}, 1e-10);
  options.core_radius = 1e-3;
  Points<2> vortex(2, 1), places(2, 3);
  vortex << 0.25, 0.5;
  places << 0.5, 0.9, 0.25, 0.6, 0.5, 5.5;
  const farfield::Values<2> values =
      farfield::Plan<2>(Kernel::vortex_blob, vortex, places, options).evaluate(Eigen::VectorXd::Constant(1, 2));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double x = 2 * lattice::pi * (places(0, i) - 0.25), y = 2 * lattice::pi * (places(1, i) - 0.5),
                 below = std::cosh(y) - std::cos(x);
    EXPECT_NEAR(values.field(0, i), -std::sinh(y) / below, 1e-9);
    EXPECT_NEAR(values.field(1, i), std::sin(x) / below, 1e-9);
  }
}

// Places beyond the faces are places in the box, seen in a mirror or shifted.
TEST(FarfieldCopies, PlacesBeyondTheBoxLieInIt) {
  for (const MirrorImages images : {MirrorImages::equal, MirrorImages::opposite})
    for (const Kernel kernel : {Kernel::coulomb, Kernel::vortex_blob}) {
      Options options = box({{Ends::mirrors, 0, 1}, {Ends::periodic, 2, 3.5}}, 1e-9, images);
      if (kernel == Kernel::vortex_blob) options.core_radius = 0.05;
      const Points<2> inside = points_in<2>(options, 50, 9);
      Points<2> shifted = inside, mirrored = inside;
      shifted.row(0).array() += 4;
      shifted.row(1).array() -= 7.5;
      mirrored.row(0) = 2 - mirrored.row(0).array();
      const Eigen::VectorXd charges = naive::charges(50, 10);
      const auto values = farfield::Plan<2>(kernel, inside, options).evaluate(charges);
      const auto same = farfield::Plan<2>(kernel, shifted, inside, options).evaluate(charges);
      EXPECT_LT((same.field - values.field).norm(), 1e-11 * values.field.norm());
      const auto beyond = farfield::Plan<2>(kernel, inside, mirrored, options).evaluate(charges);
      // The field of images is what a plan of one mirror sees there.
      const double even = (images == MirrorImages::opposite ? -1 : 1) * (kernel == Kernel::vortex_blob ? -1 : 1);
      EXPECT_LT((beyond.field.row(0) + even * values.field.row(0)).norm(), 1e-11 * values.field.norm());
      EXPECT_LT((beyond.field.row(1) - even * values.field.row(1)).norm(), 1e-11 * values.field.norm());
      if (kernel == Kernel::vortex_blob) continue;
      EXPECT_LT((beyond.potential - (images == MirrorImages::opposite ? -1 : 1) * values.potential).norm(), 1e-10);
    }
}

TEST(FarfieldCopies, ThreadsChangeNoBit) {
  Options options = box({{Ends::periodic, 0, 1}, {Ends::mirrors, 0, 1}, {Ends::periodic, 0, 1}}, 1e-4);
  const Points<3> points = naive::cube<3>(2000, 11);
  const Eigen::VectorXd charges = naive::charges(2000, 12);
  const auto one = farfield::Plan<3>(Kernel::coulomb, points, options).evaluate(charges);
  options.threads = 3;
  const auto three = farfield::Plan<3>(Kernel::coulomb, points, options).evaluate(charges);
  EXPECT_EQ(one.field, three.field);
  EXPECT_EQ(one.potential, three.potential);
}

TEST(FarfieldCopies, WhatCannotBeSummedIsRefused) {
  const Ends p = Ends::periodic;
  const Points<3> points = naive::cube<3>(4, 1);
  const Points<2> plane = naive::cube<2>(4, 1);
  const auto message = [&](const auto& places, const Options& options, Kernel kernel = Kernel::coulomb) {
    return gaussdrift::message_of<farfield::Error>(
        [&] { farfield::Plan<std::decay_t<decltype(places)>::RowsAtCompileTime>(kernel, places, options); });
  };
  EXPECT_EQ(
      message(points, box({{p, 0, 1}, {p, 0, 1}}, 1e-6)),
      "farfield: in 3 dimensions either all of Options::axes must be periodic or have mirrors at both ends, or none "
      "of them; found 2");
  EXPECT_EQ(
      message(points, box({{p, 0, 1}, {p, 0, 1}, {p, 0, 1}}, 1e-12)),
      "farfield: Options::tolerance = 1e-12 cannot be promised where Options::axes are periodic or between mirrors, "
      "must be at least 1e-11");
  EXPECT_EQ(message(plane, box({{p, 1, 1}}, 1e-6)),
            "farfield: Options::axes[0] reaches from 1 to 1, must have a positive and finite length");
  EXPECT_EQ(message(plane, box({{Ends::unbounded}, {Ends::unbounded}, {p, 0, 1}}, 1e-6)),
            "farfield: Options::axes[2] must be unbounded in 2 dimensions");
  EXPECT_EQ(message(naive::cube<1>(4, 1), box({{p, 0, 1}}, 1e-6), Kernel::log),
            "farfield: Options::axes are for 2 and 3 dimensions");
  EXPECT_EQ(
      message(plane, box({{p, 0, 1}, {p, 0, 100}}, 1e-6)),
      "farfield: Options::axes[0] has the length 1, must be at least 5 beside points that lie up to 100 apart along "
      "another axis");
  Options wide = box({{p, 0, 1}, {p, 0, 1}}, 1e-6);
  wide.core_radius = 5;
  EXPECT_NE(message(plane, wide, Kernel::vortex_blob).find("and blobs of core radius 5"), std::string::npos);
}

}  // namespace
