#include "field/named/formula.hpp"

#include <array>

#include "core/dispatch.hpp"

namespace gaussdrift::named {

CORE_DECLARE_TABLES(FormulaKernels, formula_kernels)

namespace {

constexpr std::size_t most_time_values = 2;

const FormulaKernels::Entry& kernels_of(Formula formula) {
  static const FormulaKernels& fastest = *formula_kernel_sets().back();
  return fastest.entries[static_cast<std::size_t>(formula)];
}

}  // namespace

std::vector<const FormulaKernels*> formula_kernel_sets() {
  return core::supported<FormulaKernels>(CORE_TABLES(formula_kernels));
}

void ByFormula::add_velocity(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, most_time_values> of_time{};
  at_time(t, of_time.data());
  FormulaJob job{.parameters = parameters_.data(), .count = x.count, .of_time = of_time.data()};
  for (int k = 0; k < x.dimension; ++k) job.x[k] = const_cast<double*>(x.axis[k]), job.u[k] = u.axis[k];
  kernels_of(formula_).rates(job);
}

void ByFormula::carry(const BlockSteps& steps, const std::array<double*, max_dimension>& x, std::size_t count) const {
  FormulaJob job{.parameters = parameters_.data(),
                 .count = count,
                 .stages = steps.stages,
                 .stage_weights = steps.stage_weights,
                 .weights = steps.weights,
                 .lengths = steps.lengths,
                 .of_stages = steps.of_time,
                 .steps = steps.steps};
  for (int k = 0; k < max_dimension; ++k) job.x[k] = x[k];
  kernels_of(formula_).carry(job);
}

}  // namespace gaussdrift::named
