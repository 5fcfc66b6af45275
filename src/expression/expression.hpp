// Expressions of a case file, "-y * exp(-a*t)", compiled once and evaluated over arrays.
// The one place that knows muParser. Functions, operators and constants are listed in docs/cases.md.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift {

/// A text that is not an expression: what is wrong, and where in the text (0-based position in bytes, length >= 1).
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(const std::string& message, std::size_t position, std::size_t length)
      : std::runtime_error(message), position_(position), length_(length) {}
  std::size_t position() const { return position_; }
  std::size_t length() const { return length_; }

 private:
  std::size_t position_, length_;
};

/// A function or operator without a derivative somewhere.
struct RoughSpot {
  std::string_view name;   // of the function, "?" of a choice, or empty for comparisons
  std::string_view taken;  // where, and what is taken there: "abs has a corner at 0, where slope 0 is taken"
};

/// One expression in given variables and constants (pi and e are always known).
/// Values follow IEEE arithmetic. One that is not finite (1/0, log(-1)) is no error here; callers check.
/// Evaluation is const and safe to call from several threads; the same arguments give the same bits.
/// A copy shares the compiled program.
class Expression {
 public:
  /// Throws ExpressionError; an unknown name is answered with the nearest known one.
  Expression(std::string text, std::vector<std::string> variables,
             const std::vector<std::pair<std::string, double>>& constants);
  ~Expression();
  Expression(const Expression&);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression) noexcept;

  /// values[i] = the expression at variable k = arguments[k][i], i < count. `arguments` in the order of `variables`;
  /// a variable that used_names() lacks may be null. `values` may be one of the arguments.
  void evaluate(const double* const* arguments, std::size_t count, double* values) const;
  /// For expressions of single numbers: `arguments` has one value a variable.
  double evaluate(const std::vector<double>& arguments = {}) const;

  /// The values (not written if `values` is null), and their derivatives with respect to the variables of these
  /// indices: derivatives[d][i] = d expression / d variable variables[d]. They are exact to rounding, by forward
  /// differentiation. Where there is no derivative, rough_spots() says what is taken. Neither result may be one of the arguments.
  void differentiate(const double* const* arguments, std::size_t count, const std::vector<std::size_t>& variables,
                     double* values, double* const* derivatives) const;
  /// The functions and operators of the expression that are not differentiable everywhere, each once.
  std::vector<RoughSpot> rough_spots() const;

  /// The rough cost of a value, in values of a formula with a sine or two (some 40 ns of one core).
  double cost() const;

  const std::string& text() const;
  /// Does the text mention this variable or constant?
  bool uses(std::string_view name) const;
  /// Names among the variables and constants that the text mentions, in the order of their first mention.
  const std::vector<std::string>& used_names() const;

 private:
  struct Implementation;
  std::shared_ptr<const Implementation> implementation_;
};

/// A function that expressions may call.
struct FunctionInfo {
  std::string_view name;
  int arguments;  // negative: at least -arguments
  std::string_view meaning;
};

/// All of them, in the order of docs/cases.md.
const std::vector<FunctionInfo>& expression_functions();

/// Names that an expression may not define: functions, pi, e.
bool is_reserved_name(std::string_view name);

/// A name is a letter or underscore followed by letters, digits and underscores.
bool is_name(std::string_view text);

}  // namespace gaussdrift
