// The promise at its worst place. An adversary puts one, three or two opposite charges at one spot and a crowd of
// targets at another, and climbs uphill from random starts over both places, so that the error grows. What he finds
// must keep the promise, target by target and in the root of the sum of squares; and it must come near it, since
// degrees that leave much unused are paid for.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "farfield/farfield.hpp"
#include "farfield/naive.hpp"

namespace search_test {
namespace {

using farfield::Kernel;
using farfield::Method;

// Of sums whose terms differ in size by the ratio of distances, relative to the sum of their sizes.
constexpr double rounding = 1e-14;

enum class Charges { one, three, dipole };

struct Setting {
  Kernel kernel;
  Method method;
  double tolerance;
  std::size_t leaf_size;
  Charges charges;
  bool self;                    // the sources are the targets
  Eigen::Index company, crowd;  // sources without charge around the charges, targets
};

/// Where the adversary puts things, in the unit cube.
template <int d>
struct Move {
  std::array<double, d> charge{}, crowd{};
};

struct Ratios {
  double target = 0, norm = 0;  // error over tolerance: of the worst target, of the root of the sum of squares
  double worst() const { return std::max(target, norm); }
};

template <int d>
class Adversary {
 public:
  Adversary(const Setting& setting, unsigned seed) : setting_(setting), random_(seed) {
    company_ = naive::cube<d>(setting.company, seed + 1, 0.3, 0.7);
    crowd_ = naive::cube<d>(setting.crowd, seed + 2, -0.5, 0.5);
  }

  /// The largest ratios found from `starts` starts, and how many moves were tried.
  Ratios search(int starts, int moves) {
    Ratios largest;
    for (int start = 0; start < starts; ++start) {
      Move<d> best = random_move();
      Ratios found = try_move(best);
      double step = 0.02;
      for (int m = 0; m < moves; ++m) {
        Move<d> next = best;
        auto& moving = m % 2 == 0 ? next.crowd : next.charge;
        for (double& x : moving) x = std::clamp(x + step * random_.in(-1, 1), 0.0, 1.0);
        const Ratios ratios = try_move(next);
        if (ratios.worst() > found.worst()) {
          found = ratios;
          best = next;
        } else {
          step = std::max(1e-4, step * 0.93);
        }
      }
      largest.target = std::max(largest.target, found.target);
      largest.norm = std::max(largest.norm, found.norm);
    }
    return largest;
  }

 private:
  /// Two clusters of a level that are coupled: the charge in a corner, on an edge or a face or anywhere in the one, the
  /// crowd facing it in the other or anywhere.
  Move<d> random_move() {
    const double side = random_.in(0, 1) < 0.5 ? 0.25 : 0.125;
    const int cells = static_cast<int>(1 / side);
    Move<d> move;
    bool apart = false;
    while (!apart) {
      for (std::size_t l = 0; l < d; ++l) {
        const int a = static_cast<int>(random_.in(0, cells)), b = static_cast<int>(random_.in(0, cells));
        if (std::abs(a - b) > 3) continue;
        apart = apart || std::abs(a - b) > 1;
        const bool facing = random_.in(0, 1) < 0.8;
        const bool up = a == b ? random_.in(0, 1) < 0.5 : a < b;
        const double in_a = facing ? (up ? 0.999 : 0.001) : random_.in(0, 1),
                     in_b = facing ? (up == (a == b) ? 0.999 : 0.001) : random_.in(0, 1);
        move.charge[l] = (a + in_a) * side;
        move.crowd[l] = (b + in_b) * side;
      }
    }
    return move;
  }

  Ratios try_move(const Move<d>& move) {
    const Eigen::Index charged = setting_.charges == Charges::one ? 1 : setting_.charges == Charges::three ? 3 : 2;
    farfield::Points<d> charges(d, charged), empty(d, 2 + company_.cols()), crowd(d, crowd_.cols());
    Eigen::VectorXd value = Eigen::VectorXd::Ones(charged);
    if (setting_.charges == Charges::dipole) value[1] = -1;
    // two corners give the root of the tree its place; company divides the charge's cluster, or makes it worth
    // replacing
    empty.col(0).setZero();
    empty.col(1).setConstant(0.99999);
    for (int l = 0; l < d; ++l) {
      const std::size_t axis = static_cast<std::size_t>(l);
      for (Eigen::Index j = 0; j < charged; ++j)
        charges(l, j) = move.charge[axis] + 1e-4 * static_cast<double>(j) * (l == 0 ? -1 : 0.3);
      const double corner = std::floor(move.charge[axis] * 8) / 8;
      for (Eigen::Index j = 0; j < company_.cols(); ++j) empty(l, 2 + j) = corner + 0.125 * company_(l, j);
      for (Eigen::Index j = 0; j < crowd.cols(); ++j) crowd(l, j) = move.crowd[axis] + 1e-3 * crowd_(l, j);
    }
    farfield::Points<d> sources(d, charged + empty.cols() + (setting_.self ? crowd.cols() : 0)), targets;
    sources.leftCols(charged) = charges;
    sources.middleCols(charged, empty.cols()) = empty;
    if (setting_.self) sources.rightCols(crowd.cols()) = crowd;
    Eigen::VectorXd all = Eigen::VectorXd::Zero(sources.cols());
    all.head(charged) = value;
    if (setting_.self) {
      targets = sources;
    } else {
      targets.resize(d, 2 + crowd.cols());
      targets << empty.leftCols(2), crowd;
    }

    const double core = setting_.kernel == Kernel::vortex_blob ? 0.01 : 0;
    const farfield::Options options{.tolerance = setting_.tolerance,
                                    .method = setting_.method,
                                    .threads = 1,
                                    .core_radius = core,
                                    .leaf_size = setting_.leaf_size};
    const farfield::Plan<d> plan = setting_.self ? farfield::Plan<d>(setting_.kernel, sources, options)
                                                 : farfield::Plan<d>(setting_.kernel, sources, targets, options);
    EXPECT_LE(plan.choice().bound, setting_.tolerance);
    const farfield::Values<d> values = plan.evaluate(all);

    const naive::Sums<d> exact = naive::sum<d>(setting_.kernel, charges, targets, value, core);
    Ratios ratios;
    const auto compare = [&](const auto& error_at, const Eigen::VectorXd& scale) {
      double error = 0, all_scales = 0;
      for (Eigen::Index i = 0; i < scale.size(); ++i) {
        const double e = std::max(0.0, error_at(i) - rounding * scale[i]);
        error += e * e;
        all_scales += scale[i] * scale[i];
        if (e > 0) ratios.target = std::max(ratios.target, e / (setting_.tolerance * scale[i]));
      }
      if (error > 0) ratios.norm = std::max(ratios.norm, std::sqrt(error / all_scales) / setting_.tolerance);
    };
    compare([&](Eigen::Index i) { return (values.field.col(i) - exact.field.col(i)).norm(); }, exact.field_scale);
    if (values.potential.size() > 0)
      compare([&](Eigen::Index i) { return std::abs(values.potential[i] - exact.potential[i]); },
              exact.potential_scale);
    return ratios;
  }

  Setting setting_;
  naive::Random random_;
  farfield::Points<d> company_, crowd_;
};

template <int d>
void expect_promise_at_the_worst_place(Kernel kernel, const std::vector<double>& tolerances, int settings, int starts,
                                       int moves) {
  Ratios largest;
  naive::Random random(7);
  const auto either = [&] { return random.in(0, 1) < 0.5; };
  for (const double tolerance : tolerances) {
    // Plans of one tolerance share their tables as long as one of them lives.
    const farfield::Plan<d> tables(kernel, naive::cube<d>(100, 1),
                                   {.tolerance = tolerance,
                                    .method = Method::symmetric,
                                    .core_radius = kernel == Kernel::vortex_blob ? 1e-6 : 0.0,
                                    .leaf_size = 4});
    for (int s = 0; s < settings; ++s) {
      const Eigen::Index many = d == 3 ? 1200 : 250;  // more than there are nodes
      const Setting setting{.kernel = kernel,
                            .method = s % 3 == 2 ? Method::tree : Method::symmetric,
                            .tolerance = tolerance,
                            .leaf_size = either() ? 4U : 30U,
                            .charges = std::array{Charges::one, Charges::three, Charges::dipole}[s / 3 % 3],
                            .self = either(),
                            .company = s % 3 == 2 || random.in(0, 1) < 0.2 ? many : 24,
                            .crowd = random.in(0, 1) < 0.2 ? many : 48};
      const Ratios found = Adversary<d>(setting, 10U * static_cast<unsigned>(s)).search(starts, moves);
      SCOPED_TRACE(testing::Message() << to_string(kernel) << " in " << d << "D by " << to_string(setting.method)
                                      << ", tolerance " << tolerance << ", leaves of " << setting.leaf_size
                                      << ", charges " << static_cast<int>(setting.charges) << ", company "
                                      << setting.company << ", crowd " << setting.crowd
                                      << (setting.self ? ", sources are targets" : ", targets elsewhere"));
      EXPECT_LE(found.target, 1);
      EXPECT_LE(found.norm, 1);
      largest.target = std::max(largest.target, found.target);
      largest.norm = std::max(largest.norm, found.norm);
    }
  }
  std::printf("%s in %dD: error over tolerance at most %.2f at a target, %.2f in the root of the sum of squares\n",
              to_string(kernel).c_str(), d, largest.target, largest.norm);
  EXPECT_GE(largest.target, 0.25);  // degrees are whole, one more divides the error by two to three
}

void search_everywhere(int settings, int starts, int moves) {
  const std::vector<double> in_space{1e-2, 3e-4, 1e-6, 2e-8}, in_plane{1e-2, 1e-4, 1e-7, 1e-10};
  expect_promise_at_the_worst_place<3>(Kernel::coulomb, in_space, settings, starts, moves);
  expect_promise_at_the_worst_place<2>(Kernel::coulomb, in_plane, settings, starts, moves);
  expect_promise_at_the_worst_place<2>(Kernel::log, in_plane, settings, starts, moves);
  expect_promise_at_the_worst_place<1>(Kernel::log, in_plane, settings, starts, moves);
  expect_promise_at_the_worst_place<2>(Kernel::vortex_blob, in_plane, settings, starts, moves);
}

TEST(FarfieldSearch, TheWorstPlaceKeepsThePromise) { search_everywhere(3, 3, 8); }

// By hand and nightly: minutes.
TEST(FarfieldSearch, DISABLED_TheWorstPlaceKeepsThePromiseAtLength) { search_everywhere(18, 8, 40); }

// A crowd beside a large leaf that holds the charge: potentials at the nodes of the crowd's clusters differ little, and
// the field is what they differ by.
TEST(FarfieldSearch, AFarChargeKeepsThePromiseInASmallCrowd) {
  for (const double size : {1e-3, 1e-8}) {
    farfield::Points<3> points(3, 3003);
    points.leftCols(3000) = (naive::cube<3>(3000, 1) * size).array() + 0.5;
    points.col(3000) << 0.26, 0.4, 0.45;
    points.col(3001).setZero();
    points.col(3002).setConstant(0.99999);
    Eigen::VectorXd charges = Eigen::VectorXd::Zero(3003);
    charges[3000] = 1;
    const auto exact = naive::sum<3>(Kernel::coulomb, points.col(3000), points, Eigen::VectorXd::Ones(1));
    for (const double tolerance : {1e-4, 1e-7, 2e-8}) {
      const farfield::Plan<3> plan(Kernel::coulomb, points, {.tolerance = tolerance, .method = Method::symmetric});
      const auto errors = naive::errors<3>(plan.evaluate(charges), exact);
      EXPECT_LE(std::max(errors.field, errors.potential), tolerance)
          << "crowd of size " << size << ", " << plan.choice();
      const farfield::Points<2> flat = points.topRows(2);
      const farfield::Plan<2> plane(Kernel::log, flat, {.tolerance = tolerance, .method = Method::symmetric});
      const auto in_plane = naive::errors<2>(
          plane.evaluate(charges), naive::sum<2>(Kernel::log, flat.col(3000), flat, Eigen::VectorXd::Ones(1)));
      EXPECT_LE(std::max(in_plane.field, in_plane.potential), tolerance)
          << "crowd of size " << size << ", " << plane.choice();
    }
  }
}

// The construction that broke the promise while it was relaxed: error over tolerance was 3.7 to 4.9 in space.
template <int d>
void expect_promise_for_a_crowd(Kernel kernel, double core, Eigen::Index company, Eigen::Index crowd,
                                const farfield::Points<d>& place, double tolerance) {
  farfield::Points<d> points(d, 3 + company + crowd);
  points.col(0).setZero();
  points.col(1).setConstant(0.99999);
  points.col(2).setConstant(0.125);
  points(0, 2) = 0.2499;
  points.middleCols(3, company) = naive::cube<d>(company, 1, 0, 0.02);
  points.rightCols(crowd) = naive::cube<d>(crowd, 2, 0, 0.003).colwise() + place.col(0);
  Eigen::VectorXd charges = Eigen::VectorXd::Zero(points.cols());
  charges[2] = 1;
  const farfield::Plan<d> plan(kernel, points,
                               {.tolerance = tolerance, .method = Method::symmetric, .core_radius = core});
  const auto exact = naive::sum<d>(kernel, points.col(2), points, Eigen::VectorXd::Ones(1), core);
  const auto errors = naive::errors<d>(plan.evaluate(charges), exact);
  EXPECT_LE(errors.field, tolerance) << plan.choice();
  EXPECT_LE(errors.potential, tolerance) << plan.choice();
}

TEST(FarfieldSearch, ACrowdThatFacesOneChargeKeepsThePromise) {
  for (const double tolerance : {1e-2, 1e-6})
    expect_promise_for_a_crowd<3>(Kernel::coulomb, 0, 400, 20000, farfield::Points<3>{{0.5001}, {0.125}, {0.125}},
                                  tolerance);
  for (const double tolerance : {1e-2, 1e-4})
    for (const Kernel kernel : {Kernel::coulomb, Kernel::log, Kernel::vortex_blob})
      expect_promise_for_a_crowd<2>(kernel, kernel == Kernel::vortex_blob ? 0.01 : 0, 4000, 20000,
                                    farfield::Points<2>{{0.5001}, {0.125}}, tolerance);
}

}  // namespace
}  // namespace search_test
