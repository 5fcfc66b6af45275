// Expressions: compiled, evaluated, differentiated.
#include <array>

#include "expression/expression.hpp"
#include "fuzz_target.hpp"

namespace gaussdrift {

FUZZ_TARGET(expression) {
  try {
    const Expression expression(std::string(text), {"x", "y", "t"}, {{"a", 0.5}});
    constexpr std::array<double, 5> x{0, 1, -1, 0.3, 1e300}, y{1, 0, -2, 0.7, -1e-300};
    const double* arguments[] = {x.data(), y.data(), x.data()};
    std::array<double, 5> values{}, dx{}, dy{};
    double* derivatives[] = {dx.data(), dy.data()};
    expression.evaluate(arguments, x.size(), values.data());
    expression.differentiate(arguments, x.size(), {0, 1}, values.data(), derivatives);
    expression.rough_spots();
    expression.cost();
  } catch (const ExpressionError&) {
  }
}

}  // namespace gaussdrift
