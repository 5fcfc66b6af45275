#include "expression/program.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace gaussdrift::expression {

namespace {

template <class Formula>
void combine(double* a, std::size_t count, Formula formula) {
  const double* b = a + row_length;
  for (std::size_t i = 0; i < count; ++i) a[i] = formula(a[i], b[i]);
}

template <class Formula>
void replace(double* a, std::size_t count, Formula formula) {
  for (std::size_t i = 0; i < count; ++i) a[i] = formula(a[i]);
}

}  // namespace

void run_step(const Step& step, const double* const* arguments, std::size_t first, std::size_t count, double* a) {
  switch (step.operation) {
    case Operation::constant:
      std::fill_n(a, count, step.value);
      break;
    case Operation::variable:
      std::copy_n(arguments[step.variable] + first, count, a);
      break;
    case Operation::negate:
      replace(a, count, [](double x) { return -x; });
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
    case Operation::add:
      combine(a, count, [](double x, double y) { return x + y; });
      break;
    case Operation::subtract:
      combine(a, count, [](double x, double y) { return x - y; });
      break;
    case Operation::multiply:
      combine(a, count, [](double x, double y) { return x * y; });
      break;
    case Operation::divide:
      combine(a, count, [](double x, double y) { return x / y; });
      break;
    case Operation::power:
      combine(a, count, [](double x, double y) { return std::pow(x, y); });
      break;
    case Operation::square:
      replace(a, count, [](double x) { return x * x; });
      break;
    case Operation::cube:
      replace(a, count, [](double x) { return x * x * x; });
      break;
    case Operation::fourth:
      replace(a, count, [](double x) { return (x * x) * (x * x); });
      break;
    case Operation::less:
      combine(a, count, [](double x, double y) { return x < y ? 1.0 : 0.0; });
      break;
    case Operation::greater:
      combine(a, count, [](double x, double y) { return x > y ? 1.0 : 0.0; });
      break;
    case Operation::less_equal:
      combine(a, count, [](double x, double y) { return x <= y ? 1.0 : 0.0; });
      break;
    case Operation::greater_equal:
      combine(a, count, [](double x, double y) { return x >= y ? 1.0 : 0.0; });
      break;
    case Operation::equal:
      combine(a, count, [](double x, double y) { return x == y ? 1.0 : 0.0; });
      break;
    case Operation::not_equal:
      combine(a, count, [](double x, double y) { return x != y ? 1.0 : 0.0; });
      break;
    case Operation::both:
      combine(a, count, [](double x, double y) { return x != 0 && y != 0 ? 1.0 : 0.0; });
      break;
    case Operation::either:
      combine(a, count, [](double x, double y) { return x != 0 || y != 0 ? 1.0 : 0.0; });
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
    if (!same)
      for (std::size_t k = base; k < top; ++k) stack.spread(k, count);
    run_step(*step, arguments, first, same ? 1 : count, stack.row(base));
    stack.same[base] = same;
    top = base + 1;
  }
}

}  // namespace gaussdrift::expression
