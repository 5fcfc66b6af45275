// Forward differentiation: each row of the stack carries one row of derivatives a variable,
//   d f(a, b, ...) = sum_k (df/d operand k) d operand k.
// A derivative that is 0 for the whole row is not computed. 0 times an infinite slope is 0, so sqrt(x^2 + y^2) has
// slope 0 at its corner, as abs and hypot have.
#include <array>
#include <cmath>

#include "expression/program.hpp"

namespace gaussdrift::expression {

namespace {

/// slopes[k * row_length + i] = d result / d operand k, from the operands before they are replaced.
void slopes_of(const Step& step, const double* a, std::size_t count, double* slopes) {
  const double* b = a + row_length;
  double *da = slopes, *db = slopes + row_length;
  switch (step.operation) {
    case Operation::negate:
      std::fill_n(da, count, -1.0);
      break;
    case Operation::add:
      std::fill_n(da, count, 1.0);
      std::fill_n(db, count, 1.0);
      break;
    case Operation::subtract:
      std::fill_n(da, count, 1.0);
      std::fill_n(db, count, -1.0);
      break;
    case Operation::multiply:
      std::copy_n(b, count, da);
      std::copy_n(a, count, db);
      break;
    case Operation::divide:
      for (std::size_t i = 0; i < count; ++i) {
        da[i] = 1 / b[i];
        db[i] = -(a[i] / b[i]) / b[i];
      }
      break;
    case Operation::power:
      power_slopes(a, 2, count, slopes);
      break;
    case Operation::square:
      for (std::size_t i = 0; i < count; ++i) da[i] = 2 * a[i];
      break;
    case Operation::cube:
      for (std::size_t i = 0; i < count; ++i) da[i] = 3 * (a[i] * a[i]);
      break;
    case Operation::fourth:
      for (std::size_t i = 0; i < count; ++i) da[i] = 4 * (a[i] * a[i] * a[i]);
      break;
    case Operation::call:
      step.function->slopes(a, step.operands, count, slopes);
      break;
    default:  // comparisons and logic are constant wherever they have a slope
      std::fill_n(slopes, static_cast<std::size_t>(step.operands) * row_length, 0.0);
      break;
  }
}

class Forward {
 public:
  Forward(Stack& stack, const std::vector<double*>& derivatives, std::size_t count)
      : stack_(stack), derivatives_(derivatives), count_(count), zero_(derivatives.size()) {
    for (auto& flags : zero_) flags.resize(stack.same.size(), true);
  }

  void run(const Program& program, const double* const* arguments, std::size_t first,
           const std::vector<std::size_t>& variables) {
    std::size_t top = 0;
    for (const Step& step : program) {
      const auto operands = static_cast<std::size_t>(step.operands);
      const std::size_t base = top - operands;
      const bool moving = moves(base, top);
      bool same = !moving;
      if (step.operation == Operation::variable)
        same = std::find(variables.begin(), variables.end(), step.variable) == variables.end() &&
               all_same(arguments[step.variable] + first, count_);
      for (std::size_t k = base; k < top; ++k) same = same && stack_.same[k];
      if (!same)
        for (std::size_t k = base; k < top; ++k) stack_.spread(k, count_);
      if (moving)
        combine(step, base);
      else
        for (auto& flags : zero_) flags[base] = true;
      run_step(step, arguments, first, same ? 1 : count_, stack_.row(base));
      stack_.same[base] = same;
      if (step.operation == Operation::variable) set_variable(step, base, variables);
      top = base + 1;
    }
    stack_.spread(0, count_);
    for (std::size_t d = 0; d < derivatives_.size(); ++d)
      if (zero_[d][0]) std::fill_n(derivatives_[d], count_, 0.0);
  }

 private:
  double* row(std::size_t d, std::size_t k) const { return derivatives_[d] + k * row_length; }

  bool moves(std::size_t base, std::size_t top) const {
    for (const auto& flags : zero_)
      for (std::size_t k = base; k < top; ++k)
        if (!flags[k]) return true;
    return false;
  }

  void set_variable(const Step& step, std::size_t base, const std::vector<std::size_t>& variables) {
    for (std::size_t d = 0; d < variables.size(); ++d) {
      zero_[d][base] = variables[d] != step.variable;
      if (!zero_[d][base]) std::fill_n(row(d, base), count_, 1.0);
    }
  }

  /// The derivatives of the result overwrite those of the first operand.
  void combine(const Step& step, std::size_t base) {
    const auto operands = static_cast<std::size_t>(step.operands);
    if (step.operation == Operation::choose) return choose(base);
    slopes_.resize(std::max(slopes_.size(), operands * row_length));
    slopes_of(step, stack_.row(base), count_, slopes_.data());
    for (std::size_t d = 0; d < derivatives_.size(); ++d) {
      double* result = row(d, base);
      bool zero = zero_[d][base];
      if (!zero)
        for (std::size_t i = 0; i < count_; ++i) result[i] = result[i] == 0 ? 0.0 : result[i] * slopes_[i];
      for (std::size_t k = 1; k < operands; ++k) {
        if (zero_[d][base + k]) continue;
        const double *inner = row(d, base + k), *slope = slopes_.data() + k * row_length;
        for (std::size_t i = 0; i < count_; ++i) {
          const double part = inner[i] == 0 ? 0.0 : inner[i] * slope[i];
          result[i] = zero ? part : result[i] + part;
        }
        zero = false;
      }
      zero_[d][base] = zero;
    }
  }

  void choose(std::size_t base) {
    const double* condition = stack_.row(base);
    for (std::size_t d = 0; d < derivatives_.size(); ++d) {
      double* result = row(d, base);
      for (std::size_t i = 0; i < count_; ++i) {
        const std::size_t taken = condition[i] != 0 ? base + 1 : base + 2;
        result[i] = zero_[d][taken] ? 0.0 : row(d, taken)[i];
      }
      zero_[d][base] = zero_[d][base + 1] && zero_[d][base + 2];
    }
  }

  Stack& stack_;
  const std::vector<double*>& derivatives_;
  std::size_t count_;
  std::vector<std::vector<char>> zero_;  // [variable][row of the stack]: no derivative there, the row is not set
  std::vector<double> slopes_;
};

}  // namespace

void run_with_derivatives(const Program& program, const double* const* arguments, std::size_t first, std::size_t count,
                          const std::vector<std::size_t>& variables, Stack& stack,
                          const std::vector<double*>& derivatives) {
  Forward(stack, derivatives, count).run(program, arguments, first, variables);
}

}  // namespace gaussdrift::expression
