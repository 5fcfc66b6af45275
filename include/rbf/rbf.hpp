/// @file
/// Sums of radial basis functions and of their derivatives: the library rbf.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <fgtd/fgtd.hpp>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rbf/kernel.hpp"

/// Sums of radial basis functions and of their derivatives in d = 1, 2, 3 dimensions, to a promised accuracy:
///
///     s_alpha(y) = D^alpha sum_j lambda_j phi(|y - x_j|)
///
/// Every kernel phi is replaced by a few Gaussians, whose sums the library fgtd computes in linear time. docs/rbf.md
/// explains how, the promise and the costs. In short:
///
///     const rbf::Plan<2> plan({rbf::Kernel::multiquadric, 0.3}, centres, weights, {.tolerance = 1e-6});
///     const Eigen::MatrixXd values = plan.evaluate(targets);
///
/// Bad input throws an Error. Nothing is printed, and there is no global state. Evaluation is const, and several threads
/// may call it at a time. Results do not depend on the number of threads.
namespace rbf {

// ---------------------------------------------------------------------------------------------------------------
// Errors

/// Base of all exceptions of this library.
class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// An argument breaks a rule; the message names the argument, its value (and index) and the rule.
class InvalidArgument : public Error {
  using Error::Error;
};
/// The tolerance cannot be promised.
class ToleranceError : public Error {
  using Error::Error;
};
/// The work would need more memory than Options::memory_limit; thrown before anything large is allocated.
class MemoryLimitError : public Error {
 public:
  /// Keeps the numbers beside the message.
  MemoryLimitError(const std::string& message, double needed_bytes, std::size_t limit_bytes)
      : Error(message), needed(needed_bytes), limit(limit_bytes) {}
  double needed;      ///< bytes that the work would take, or its largest part
  std::size_t limit;  ///< that there are for it, bytes
};
enum class Method;
/// The work is predicted to take longer than Options::most_seconds; thrown before any sum is begun.
class TimeLimitError : public Error {
 public:
  /// Keeps the numbers beside the message.
  TimeLimitError(const std::string& message, double predicted, Method chosen)
      : Error(message), seconds(predicted), method(chosen) {}
  double seconds;  ///< predicted, on one thread
  Method method;   ///< that the prediction is for
};

// ---------------------------------------------------------------------------------------------------------------
// Kernels

/// A kernel with its shape: phi.
struct Function {
  Kernel kernel = Kernel::multiquadric;  ///< which
  double shape = 0;                      ///< c > 0, in the units of the points; 0 for thin_plate, which has none
};

/// Every kernel.
const std::vector<Kernel>& kernels();
/// The name as it is written in files: "inverse-multiquadric".
std::string to_string(Kernel kernel);
/// The kernel of that name, if there is one.
std::optional<Kernel> kernel_named(const std::string& name);
/// Its formula: "1 / sqrt(r^2 + c^2)".
std::string formula(Kernel kernel);
/// Whether it has a shape c.
bool takes_shape(Kernel kernel);
/// The order m of conditional positive definiteness, up to sign: a matrix of the kernel at distinct points is definite
/// on weights that are orthogonal to the polynomials of degree below m. 0: on all weights.
int positive_order(Kernel kernel);
/// Highest derivative of the kernel that is finite everywhere, at most 2: that Options::derivative_order may be.
int highest_derivative(Kernel kernel);

/// How many derivatives of x -> phi(|x|) are continuous everywhere; the largest int if all are.
int continuous_derivatives(Kernel kernel);

/// phi(r).
/// @throws InvalidArgument  r is negative or not finite, or the shape is not what the kernel takes
double value(const Function& function, double r);
/// phi'(r).
/// @throws InvalidArgument  as value()
double derivative(const Function& function, double r);
/// The largest |phi(r)|, 0 <= r <= range.
/// @throws InvalidArgument  as value()
double largest_value(const Function& function, double range);
/// The largest |phi|, |phi'|, or of |phi''| and |phi'/r|, 0 <= r <= range: what the errors of derivatives of that order
/// are relative to.
/// @param function  the kernel and its shape
/// @param range     of distances
/// @param order     0, 1 or 2, at most highest_derivative()
/// @throws InvalidArgument  as value(), or for another order
double largest_derivative(const Function& function, double range, int order);

// ---------------------------------------------------------------------------------------------------------------
// Arguments

/// Points as columns: d x m.
template <int d>
using Points = fgtd::Points<d>;
/// Multi-index alpha of a derivative D^alpha.
template <int d>
using Derivative = fgtd::Derivative<d>;
/// A linear differential operator: Laplacian, one component of a gradient.
template <int d>
using Combination = fgtd::Combination<d>;
/// A tensor grid: one ascending node list per axis. Values on it run with the first axis fastest.
using TensorGrid = fgtd::TensorGrid;

/// How the sum is computed; docs/rbf.md, "Methods".
enum class Method {
  automatic,  ///< the method with the smaller predicted time
  direct,     ///< every pair of a centre and a target
  gaussians   ///< the kernel is a sum of Gaussians, each a fast Gauss transform
};

/// Every method, `automatic` first.
const std::vector<Method>& methods();
/// The name as it is written in files: "auto", "direct", "gaussians".
std::string to_string(Method method);
/// What it does, in a line.
std::string meaning(Method method);

/// What a Plan is asked for. The defaults are valid.
struct Options {
  double tolerance = 1e-6;            ///< see Plan; smallest_tolerance <= tolerance < 1, unless the method is `direct`
  int derivative_order = 0;           ///< highest |alpha| that evaluate() can return, 0 .. highest_derivative(kernel)
  Method method = Method::automatic;  ///< how
  int threads = 0;                    ///< 0: all
  std::size_t memory_limit = std::size_t{8} << 30;                ///< bytes that plan and evaluation may hold together
  double most_seconds = std::numeric_limits<double>::infinity();  ///< that may be predicted, for one thread

  /// R: no target is farther from a corner of the box around the centres. 0: the diagonal of that box, which suits
  /// targets inside it. range_of() tells it for given targets.
  double range = 0;
  /// Scattered targets that will be evaluated; 0: as many as centres. For the prediction of cost only.
  std::size_t expected_targets = 0;
  /// The grid that will be evaluated, in place of scattered targets. For the prediction of cost only.
  std::optional<TensorGrid> expected_grid = {};
};

/// Tolerances below are not promised by `gaussians`; `automatic` takes `direct` there.
constexpr double smallest_tolerance = 1e-11;

/// The largest distance of a target from a corner of the box around the centres: what Options::range must be at least.
/// 0 if there are no centres or no targets.
template <int d>
double range_of(const Eigen::Ref<const Points<d>>& centres, const Eigen::Ref<const Points<d>>& targets);

// ---------------------------------------------------------------------------------------------------------------
// What was chosen

/// weight exp(-exponent r^2), and how the sum of it is computed.
struct Gaussian {
  double exponent = 0;  ///< t, in 1/length^2
  double weight = 0;    ///< w
  fgtd::Choice choice;  ///< of the Gauss transform
};

/// The method that a Plan has chosen, its parameters, and what it promises and predicts.
struct Choice {
  Function function;                   ///< that was asked for
  Method method = Method::direct;      ///< never `automatic`
  double tolerance = 0;                ///< what was asked for
  double range = 0;                    ///< R: what the promise is for
  double largest = 0;                  ///< max |phi| on [0, R]: what the promise is relative to
  double kernel_error = 0;             ///< gaussians: measured error of the kernel on [0, R], relative to that
  double bound = 0;                    ///< gaussians: of the error, relative to it too; <= tolerance
  std::array<double, 3> polynomial{};  ///< gaussians: beyond `near` the kernel is p_0 + p_1 r^2 + p_2 r^4 + `terms`
  std::vector<Gaussian> terms;         ///< gaussians: widest first
  std::size_t transforms = 0;          ///< gaussians: Gauss transforms; Gaussians of similar widths share one
  double near = 0;                     ///< gaussians: pairs that are closer are summed one by one
  double seconds = 0;                  ///< predicted, on one thread
  std::size_t centres = 0;             ///< N
  std::size_t targets = 0;             ///< that the prediction is for
};

/// One line: kernel, method, terms, bound and predicted seconds.
std::ostream& operator<<(std::ostream& out, const Choice& choice);

// ---------------------------------------------------------------------------------------------------------------
// The plan

namespace detail {
template <int d>
class Engine;
}

/// A prepared sum. What is promised, for all centres and weights and at every target within the range R:
///
///     |error of s|            <= tolerance  max |phi|     sum_j |lambda_j|
///     |error of grad s|       <= tolerance  max |phi'|    sum_j |lambda_j|       if derivative_order >= 1
///     |error of d^2 s / d^2|  <= tolerance  max |D^2 phi| sum_j |lambda_j|       if derivative_order = 2
///
/// with the maxima over 0 <= r <= R, |D^2 phi| the larger of |phi''| and |phi'/r|. The second line holds for every
/// component, the third for every second derivative. A combination has the sum of |coefficient| times these. Rounding
/// adds about 1e-13 of the same numbers, and `direct` has rounding alone.
template <int d>
class Plan {
  static_assert(1 <= d && d <= 3, "rbf: dimensions 1 to 3");

 public:
  /// Chooses a method and prepares it.
  /// @param function  the kernel and its shape
  /// @param centres   d x N, any N >= 0, finite; some may coincide
  /// @param weights   N x c: c columns that share centres and evaluation, finite
  /// @param options   what is asked for
  /// @throws InvalidArgument   an argument breaks one of these rules
  /// @throws ToleranceError    the tolerance cannot be promised
  /// @throws MemoryLimitError  plan and evaluation would need more than Options::memory_limit
  /// @throws TimeLimitError    they are predicted to take longer than Options::most_seconds
  Plan(const Function& function, const Eigen::Ref<const Points<d>>& centres,
       const Eigen::Ref<const Eigen::MatrixXd>& weights, const Options& options = {});
  ~Plan();
  /// A plan can be moved; what is left can be assigned to or destroyed, nothing else.
  Plan(Plan&&) noexcept;
  /// The same.
  Plan& operator=(Plan&&) noexcept;

  /// D^alpha of the sum at scattered targets. A centre at a target counts with the kernel's value at 0.
  /// @param targets  d x M, finite, within the range
  /// @param alpha    the derivative; the sum itself by default
  /// @returns M x c
  /// @throws InvalidArgument   a target is not finite or out of range, or |alpha| is above Options::derivative_order
  /// @throws MemoryLimitError  the evaluation would need more than Options::memory_limit
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// The same on a tensor grid.
  /// @param grid   d axes of finite, ascending nodes
  /// @param alpha  the derivative; the sum itself by default
  /// @returns grid.size() x c, the first axis fastest
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const Derivative<d>& alpha = {}) const;

  /// Several linear combinations of derivatives in one pass: value and gradient, Laplacian.
  /// @param targets       d x M, as of evaluate()
  /// @param combinations  each a list of derivatives with coefficients
  /// @returns M x (c * combinations.size()); the columns of the first combination come first
  /// @throws InvalidArgument, MemoryLimitError  as evaluate()
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  /// The same on a tensor grid, first axis fastest.
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;

  /// Keeps centres and function, and takes other weights.
  /// @param weights  N x c, finite; c may be another than before
  /// @throws InvalidArgument, MemoryLimitError  as the constructor
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  /// What was chosen, and what it promises and predicts.
  const Choice& choice() const;

 private:
  std::unique_ptr<detail::Engine<d>> engine_;
};

namespace detail {
/// As in fgtd: Eigen's way of allocating follows from the flags a file is compiled with; a program compiled in another
/// way than the library does not link, where it would corrupt the heap.
template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_rbf();
namespace {
[[maybe_unused, gnu::used]] void (*const same_flags)() =
    &compile_with_the_same_march_and_sanitizer_flags_as_rbf<EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;
}  // namespace
}  // namespace detail

extern template class Plan<1>;
extern template class Plan<2>;
extern template class Plan<3>;

}  // namespace rbf
