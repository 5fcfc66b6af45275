// Named fields whose formula has a kernel (formulas.hpp): one statement of u, from which come its values at many points and
// whole steps of particles.
#pragma once

#include <utility>
#include <vector>

#include "field/named/formula_job.hpp"
#include "field/named/named.hpp"
#include "field/velocity/block_carrier.hpp"

namespace gaussdrift::named {

/// Those for each instruction set that this machine runs, slowest first.
std::vector<const FormulaKernels*> formula_kernel_sets();

/// u of the formula with these parameters, whose order its struct in formulas.hpp tells.
class ByFormula : public BlockCarrier {
 public:
  ByFormula(Formula formula, std::vector<double> parameters) : formula_(formula), parameters_(std::move(parameters)) {}
  /// u[k][i] += u_k(x_i, t).
  void add_velocity(double t, const PointsView& x, const VectorsView& u) const;
  std::size_t time_values() const override { return 0; }
  void at_time(double /*t*/, double* /*values*/) const override {}
  void carry(const BlockSteps& steps, const std::array<double*, max_dimension>& x, std::size_t count) const override;

 private:
  Formula formula_;
  std::vector<double> parameters_;
};

/// A field of class Field whose u is the formula.
template <class Field>
class FormulaField : public Field, private ByFormula {
 public:
  using ByFormula::ByFormula;
  void add(double t, const PointsView& x, const VectorsView& u) const final { add_velocity(t, x, u); }
  const BlockCarrier* block_carrier() const final { return this; }
};

}  // namespace gaussdrift::named
