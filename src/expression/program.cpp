#include "expression/program.hpp"

#include <bit>
#include <cstdint>

#include "rows/rows.hpp"

namespace gaussdrift::expression {

namespace {

/// The kernel of an operation with two operands; null for others.
rows::Binary binary_kernel(Operation operation) {
  const rows::Kernels& kernels = rows::kernels();
  switch (operation) {
    case Operation::add:
      return kernels.add;
    case Operation::subtract:
      return kernels.subtract;
    case Operation::multiply:
      return kernels.multiply;
    case Operation::divide:
      return kernels.divide;
    case Operation::power:
      return kernels.pow;
    case Operation::less:
      return kernels.less;
    case Operation::greater:
      return kernels.greater;
    case Operation::less_equal:
      return kernels.less_equal;
    case Operation::greater_equal:
      return kernels.greater_equal;
    case Operation::equal:
      return kernels.equal;
    case Operation::not_equal:
      return kernels.not_equal;
    case Operation::both:
      return kernels.both;
    case Operation::either:
      return kernels.either;
    default:
      return nullptr;
  }
}

}  // namespace

void run_step(const Step& step, const double* const* arguments, std::size_t first, std::size_t count, double* a) {
  if (const rows::Binary combine = binary_kernel(step.operation)) return combine(a, a + row_length, false, count);
  switch (step.operation) {
    case Operation::constant:
      std::fill_n(a, count, step.value);
      break;
    case Operation::variable:
      std::copy_n(arguments[step.variable] + first, count, a);
      break;
    case Operation::negate:
      rows::kernels().negate(a, count);
      break;
    case Operation::call:
      step.function->apply(a, step.operands, count);
      break;
    case Operation::choose: {
      const double *b = a + row_length, *c = b + row_length;
      for (std::size_t i = 0; i < count; ++i) {
        const double yes = b[i], no = c[i];  // loaded both, so that no branch is needed
        a[i] = a[i] != 0 ? yes : no;
      }
      break;
    }
    case Operation::square:
      rows::kernels().square(a, count);
      break;
    case Operation::cube:
      rows::kernels().cube(a, count);
      break;
    case Operation::fourth:
      rows::kernels().fourth(a, count);
      break;
    default:
      break;
  }
}

bool all_same(const double* values, std::size_t count) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return std::all_of(values, values + count, [&](double value) { return bits(value) == bits(*values); });
}

void run(const Step* step, std::size_t steps, const double* const* arguments, std::size_t first, std::size_t count,
         Stack& stack) {
  std::size_t top = 0;  // the first free row
  for (const Step* end = step + steps; step != end; ++step) {
    const std::size_t operands = static_cast<std::size_t>(step->operands), base = top - operands;
    bool same = true;
    if (step->operation == Operation::variable) {
      same = all_same(arguments[step->variable] + first, count);
    }
    for (std::size_t k = base; k < top; ++k) same = same && stack.same[k];
    const rows::Binary combine = same ? nullptr : binary_kernel(step->operation);
    if (combine) {  // the second row need not be spread
      stack.spread(base, count);
      combine(stack.row(base), stack.row(base + 1), stack.same[base + 1], count);
    } else {
      if (!same)
        for (std::size_t k = base; k < top; ++k) stack.spread(k, count);
      run_step(*step, arguments, first, same ? 1 : count, stack.row(base));
    }
    stack.same[base] = same;
    top = base + 1;
  }
}

}  // namespace gaussdrift::expression
