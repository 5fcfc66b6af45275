// examples/coulomb_forces.cpp: potential and field of charges on each other, by the library farfield alone.
#include <cstdio>
#include <farfield/farfield.hpp>

int main() {
  // 30 000 charges in the unit cube, half of them negative.
  const int count = 30000;
  const farfield::Points<3> places = farfield::Points<3>::Random(3, count);  // a column is a point
  Eigen::VectorXd charges(count);
  for (int i = 0; i < count; ++i) charges[i] = i % 2 ? 1.0 : -1.0;

  // Sources and targets are the same points here; a charge does not act on itself.
  const farfield::Plan<3> plan(farfield::Kernel::coulomb, places, places, {.tolerance = 1e-6});
  const farfield::Values<3> values = plan.evaluate(charges);
  const double energy = 0.5 * charges.dot(values.potential);

  // The same for a hundred of the targets by summing all pairs.
  const farfield::Points<3> few = places.leftCols(100);
  const farfield::Plan<3> all_pairs(farfield::Kernel::coulomb, places, few, {.method = farfield::Method::direct});
  const farfield::Values<3> exact = all_pairs.evaluate(charges);
  const double error = (values.field.leftCols(100) - exact.field).norm() / exact.field.norm();

  std::printf("energy %.6g, relative error of the field %.1e\n", energy, error);
  return error <= 1e-6 ? 0 : 1;
}
