// What `[effects.charge]` and `[effects.vortex]` promise with their tolerance, at the worst place that an adversary
// finds: one particle that carries, and a crowd that carries nothing but is moved, against the sum by its definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "effect/pair_velocity.hpp"
#include "farfield/naive.hpp"

namespace gaussdrift {
namespace {

// Enough that the sum is worth clusters.
template <int d>
constexpr Eigen::Index company = d == 3 ? 12000 : 1500;
constexpr Eigen::Index crowd = 1500;
constexpr double core = 0.005;

template <int d>
class Adversary {
 public:
  explicit Adversary(double tolerance, unsigned seed)
      : tolerance_(tolerance),
        sums_(tolerance, 1),
        random_(seed),
        company_(naive::cube<d>(company<d>, seed + 1)),
        crowd_(naive::cube<d>(crowd, seed + 2, -0.5, 0.5)) {}

  /// Error over the promise of the worst particle.
  double search(int moves) {
    farfield::Points<d> best(d, 2);  // the one that carries, the middle of the crowd
    const double side = 0.125;
    for (int l = 0; l < d; ++l) {
      const int cell = static_cast<int>(random_.in(0, 5));
      best(l, 0) = (cell + (l == 0 ? 0.999 : 0.001)) * side;
      best(l, 1) = (cell + (l == 0 ? 2.001 : 0.001)) * side;
    }
    double largest = ratio(best), step = 0.01;
    for (int m = 0; m < moves; ++m) {
      farfield::Points<d> next = best;
      for (double& x : next.reshaped()) x = std::clamp(x + step * random_.in(-1, 1), 0.0, 1.0);
      const double found = ratio(next);
      if (found > largest) {
        largest = found;
        best = next;
      } else {
        step *= 0.9;
      }
    }
    return largest;
  }
  bool interpolated() const { return interpolated_; }

 private:
  double ratio(const farfield::Points<d>& place) {
    farfield::Points<d> points(d, 1 + company<d> + crowd);
    points << place.col(0), company_, (2e-3 * crowd_).colwise() + place.col(1);
    std::vector<double> axes[d], weights(static_cast<std::size_t>(points.cols()), 0.0);
    weights[0] = 1;
    PointsView view;
    view.dimension = d;
    view.count = weights.size();
    for (int l = 0; l < d; ++l) {
      axes[l].assign(points.row(l).begin(), points.row(l).end());
      view.axis[static_cast<std::size_t>(l)] = axes[l].data();
    }
    farfield::Points<d> found;
    if constexpr (d == 2)
      found = sums_.vortices(view, {}, weights, core);
    else
      found = sums_.charges(view, {}, weights);
    const auto exact = naive::sum<d>(d == 2 ? farfield::Kernel::vortex_blob : farfield::Kernel::coulomb, points.col(0),
                                     points, Eigen::VectorXd::Ones(1), core);
    double largest = 0;
    for (Eigen::Index i = 1; i < points.cols(); ++i)
      largest = std::max(largest, (found.col(i) - exact.field.col(i)).norm() / (tolerance_ * exact.field_scale[i]));
    interpolated_ = interpolated_ || sums_.last_choice().clusters > 1;
    return largest;
  }

  double tolerance_;
  PairVelocity sums_;
  naive::Random random_;
  farfield::Points<d> company_, crowd_;
  bool interpolated_ = false;
};

template <int d>
void expect_promise() {
  double largest = 0;
  int interpolated = 0;
  for (const double tolerance : {1e-2, 1e-4})
    for (unsigned seed = 1; seed <= 2; ++seed) {
      Adversary<d> adversary(tolerance, 10 * seed);
      const double found = adversary.search(10);
      EXPECT_LE(found, 1) << d << "D, tolerance " << tolerance << ", seed " << seed;
      largest = std::max(largest, found);
      interpolated += adversary.interpolated();
    }
  std::printf("%dD: error over the promise at most %.2f\n", d, largest);
  EXPECT_GT(interpolated, 0);  // else nothing was tried that could break it
}

TEST(PairVelocity, KeepsTheToleranceOfVorticesAtTheWorstPlace) { expect_promise<2>(); }
TEST(PairVelocity, KeepsTheToleranceOfChargesAtTheWorstPlace) { expect_promise<3>(); }

}  // namespace
}  // namespace gaussdrift
