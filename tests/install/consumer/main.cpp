// Sums with known values, by all that the header declares. Exits with 1 and says why if one is wrong.
#include <cmath>
#include <cstdio>
#include <fgtd/fgtd.hpp>
#include <sstream>

namespace {

int failures = 0;

void expect(const char* what, double value, double expected, double allowed) {
  if (std::abs(value - expected) <= allowed) return;
  std::printf("%s is %.17g, must be %.17g to within %g\n", what, value, expected, allowed);
  ++failures;
}

template <int d>
void check_one_gaussian() {
  fgtd::Points<d> source = fgtd::Points<d>::Constant(d, 1, 0.25), target = source;
  target(0, 0) += 0.5;
  fgtd::Plan<d> plan(source, Eigen::MatrixXd::Constant(1, 1, 3.0), 2.0, {.tolerance = 1e-12, .derivative_order = 1});
  const double value = 3 * std::exp(-0.5);  // 3 exp(-2 (1/2)^2)
  fgtd::Derivative<d> slope{};
  slope[0] = 1;
  // 1e-11: the tolerance times the weight 3 and N_alpha = 2, and rounding
  expect("a Gaussian", plan.evaluate(target)(0, 0), value, 1e-11);
  expect("its slope", plan.evaluate(target, slope)(0, 0), -2 * value, 1e-11);
  plan.set_weights(Eigen::MatrixXd::Constant(1, 2, -1.0));
  expect("with another weight", plan.evaluate(target)(0, 1), -value / 3, 1e-11);
}

// Many sources, so that matrices change hands between this program and the library again and again.
void check_a_lattice() {
  const int n = 60;
  fgtd::Points<2> sources(2, n * n);
  for (int i = 0; i < n * n; ++i) sources.col(i) << (i % n) / (n - 1.0), (i / n) / (n - 1.0);
  const double h = 1 / (n - 1.0), sigma = 400;
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Constant(n * n, 1, h * h * sigma / std::acos(-1.0));
  const fgtd::TensorGrid grid{{{0.5}, {0.4, 0.5}}};
  for (const fgtd::Method method : fgtd::methods()) {
    const fgtd::Plan<2> plan(sources, weights, sigma, {.tolerance = 1e-9, .method = method, .expected_grid = grid});
    std::ostringstream chosen;
    chosen << plan.choice();
    // The trapezoidal rule of a Gaussian of this width is exact to exp(-pi^2 / (sigma h^2)) = 1e-37; the parts outside
    // the square are erfc(8) of the whole. 1e-6: tolerance 1e-9 times the sum of the weights around, 127 / h^2 h^2.
    Eigen::MatrixXd values;
    for (int times = 0; times < 20; ++times) values = plan.evaluate(grid);
    expect(chosen.str().c_str(), values(0, 0), 1, 1e-6);
    expect(chosen.str().c_str(), values(1, 0), 1, 1e-6);
  }
}

}  // namespace

int main() {
  check_one_gaussian<1>();
  check_one_gaussian<2>();
  check_one_gaussian<3>();
  check_one_gaussian<4>();
  check_a_lattice();
  try {
    fgtd::Plan<1>(fgtd::Points<1>::Zero(1, 1), Eigen::MatrixXd::Ones(1, 1), -1.0);
    std::puts("a negative sigma was taken");
    ++failures;
  } catch (const fgtd::InvalidArgument&) {
  }
  if (failures == 0) std::puts("all sums are right");
  return failures == 0 ? 0 : 1;
}
