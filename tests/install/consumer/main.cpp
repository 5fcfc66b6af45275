// Sums with known values, by all that the header declares. Exits with 1 and says why if one is wrong.
#include <cmath>
#include <cstdio>
#include <farfield/farfield.hpp>
#include <fgtd/fgtd.hpp>
#include <rbf/rbf.hpp>
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

// Charges on a sphere: outside they act as if all were in its centre.
void check_a_charged_sphere() {
  const int n = 6000;
  farfield::Points<3> sources(3, n), targets(3, 1);
  for (int i = 0; i < n; ++i) {
    const double z = (2 * i + 1.0) / n - 1, angle = 2.399963229728653 * i, radius = std::sqrt(1 - z * z);
    sources.col(i) << radius * std::cos(angle), radius * std::sin(angle), z;
  }
  targets << 3, 0, 0;
  for (const farfield::Method method : farfield::methods()) {
    const farfield::Plan<3> plan(farfield::Kernel::coulomb, sources, targets, {.tolerance = 1e-5, .method = method});
    const farfield::Values<3> values = plan.evaluate(Eigen::VectorXd::Constant(n, 1.0 / n));
    expect("the potential of a sphere", values.potential[0], 1.0 / 3, 1e-5);
    expect("the field of a sphere", values.field(0, 0), 1.0 / 9, 1e-5);
  }
}

// Two centres of every kernel, by both methods.
void check_kernels() {
  rbf::Points<1> centres(1, 2), target(1, 1);
  centres << 0, 1;
  target << 0.25;
  for (const rbf::Kernel kernel : rbf::kernels())
    for (const rbf::Method method : rbf::methods()) {
      const rbf::Function function{kernel, rbf::takes_shape(kernel) ? 0.5 : 0};
      const rbf::Plan<1> plan(function, centres, Eigen::MatrixXd::Ones(2, 1), {.tolerance = 1e-7, .method = method});
      // 2e-7: the tolerance times two weights of 1
      expect(rbf::to_string(kernel).c_str(), plan.evaluate(target)(0, 0),
             rbf::value(function, 0.25) + rbf::value(function, 0.75), 2e-7 * rbf::largest_value(function, 1));
    }
}

}  // namespace

int main() {
  check_one_gaussian<1>();
  check_one_gaussian<2>();
  check_one_gaussian<3>();
  check_one_gaussian<4>();
  check_a_lattice();
  check_a_charged_sphere();
  check_kernels();
  try {
    fgtd::Plan<1>(fgtd::Points<1>::Zero(1, 1), Eigen::MatrixXd::Ones(1, 1), -1.0);
    std::puts("a negative sigma was taken");
    ++failures;
  } catch (const fgtd::InvalidArgument&) {
  }
  if (failures == 0) std::puts("all sums are right");
  return failures == 0 ? 0 : 1;
}
