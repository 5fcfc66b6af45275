/// @file
/// Sums of Gaussians and of their derivatives: the library fgtd, whole.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

/// Sums of Gaussians and of their derivatives in d = 1, 2, 3, 4 dimensions, to a promised accuracy:
///
///     s_alpha(y) = D^alpha sum_j lambda_j exp(-sigma |y - x_j|^2)
///
/// docs/fgtd.md explains the methods, the promise and the costs. In short:
///
///     const fgtd::Plan<2> plan(sources, weights, sigma, {.tolerance = 1e-8, .derivative_order = 1});
///     const Eigen::MatrixXd values = plan.evaluate(targets, {0, 1});
///
/// Bad input throws an Error. Nothing is printed, and there is no global state. Evaluation is const, and several threads
/// may call it at a time. Results do not depend on the number of threads.
namespace fgtd {

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
/// The tolerance cannot be promised (below smallest_tolerance, or not reachable by the chosen method).
class ToleranceError : public Error {
  using Error::Error;
};
/// The work would need more memory than Options::memory_limit; thrown before anything is allocated.
class MemoryLimitError : public Error {
 public:
  /// Keeps the numbers beside the message.
  MemoryLimitError(const std::string& message, double needed_bytes, std::size_t limit_bytes)
      : Error(message), needed(needed_bytes), limit(limit_bytes) {}
  double needed;      ///< bytes that the work would take
  std::size_t limit;  ///< Options::memory_limit, bytes
};

enum class Method;
/// The work is predicted to take longer than Options::most_seconds; thrown before it is begun.
class TimeLimitError : public Error {
 public:
  /// Keeps the numbers beside the message.
  TimeLimitError(const std::string& message, double predicted, Method chosen)
      : Error(message), seconds(predicted), method(chosen) {}
  double seconds;  ///< predicted, on one thread
  Method method;   ///< that the prediction is for
};

// ---------------------------------------------------------------------------------------------------------------
// Arguments

/// Points as columns: d x m, so that a point's coordinates are contiguous.
template <int d>
using Points = Eigen::Matrix<double, d, Eigen::Dynamic>;

/// Multi-index alpha of a derivative D^alpha.
template <int d>
using Derivative = std::array<int, d>;

/// coefficient * D^derivative.
template <int d>
struct Term {
  Derivative<d> derivative{};  ///< its multi-index; the value itself by default
  double coefficient = 1;      ///< its factor
};

/// A linear differential operator: Laplacian, cutoff function, one component of a gradient.
template <int d>
using Combination = std::vector<Term<d>>;

/// A tensor grid: one ascending node list per axis. Values on it run with the first axis fastest.
struct TensorGrid {
  std::vector<std::vector<double>> axes;  ///< nodes of every axis, ascending

  /// Number of points: the product over the axes.
  std::size_t size() const {
    std::size_t product = axes.empty() ? 0 : 1;
    for (const auto& nodes : axes) product *= nodes.size();
    return product;
  }
};

/// How the sum is computed; docs/fgtd.md, "Methods".
enum class Method {
  automatic,      ///< the method with the smallest predicted time whose bound meets the tolerance
  direct,         ///< every pair of a source and a target: for few points
  hermite,        ///< the thesis's method: Hermite series of boxes of sources [Sch06, ch. 3 and 4]
  cells,          ///< pairs within reach, found by cells: for sharp Gaussians
  outer_product,  ///< outer products of a row of values an axis: for few sources on a tensor grid
  chebyshev,      ///< interpolation at Chebyshev nodes of boxes: for wide Gaussians
  spread          ///< a window spreads the sources to a lattice, where filters act axis by axis: for dense clouds
};

/// Every method, `automatic` first.
const std::vector<Method>& methods();

/// The name as it is written in files: "auto", "direct", "hermite", "cells", "outer", "chebyshev", "spread".
std::string to_string(Method method);

/// How the method sums and when it is good, in one line.
std::string meaning(Method method);

/// Parameters of `hermite` set by hand. The accuracy is then bound (3.5) of [Sch06, 3.7] and nothing else.
struct HermiteParameters {
  double box_scale = 0.5;      ///< r: boxes have the side r sqrt(2/sigma); bound (3.5) needs r < 1
  int expansion_order = 9;     ///< p: terms an axis
  int neighbours = all_boxes;  ///< n: boxes a side and axis that count; all_boxes: every box

  static constexpr int all_boxes = -1;  ///< value of `neighbours` with which every box counts
};

/// What a Plan is asked for. The defaults are valid.
struct Options {
  double tolerance = 1e-6;            ///< of each Gaussian term, see Plan; smallest_tolerance <= tolerance < 1
  int derivative_order = 0;           ///< highest |alpha| that evaluate() can return; above 12 for tolerance <= 1e-4
  Method method = Method::automatic;  ///< how; where a named one cannot serve, `direct` takes its place
  int threads = 0;                    ///< 0: all
  std::size_t memory_limit = std::size_t{8} << 30;                ///< bytes that plan and evaluation may hold together
  double most_seconds = std::numeric_limits<double>::infinity();  ///< that may be predicted, for one thread

  /// Scattered targets that will be evaluated; 0: as many as sources. For the prediction of cost only: other targets
  /// stay possible.
  std::size_t expected_targets = 0;
  /// The grid that will be evaluated, in place of scattered targets. For the prediction of cost only.
  std::optional<TensorGrid> expected_grid = {};

  std::optional<HermiteParameters> hermite = {};  ///< by hand; implies Method::hermite
};

/// Tolerances below cannot be promised in double precision.
constexpr double smallest_tolerance = 1e-14;

// ---------------------------------------------------------------------------------------------------------------
// What was chosen

// The parameters of every method, in its own words.

/// `direct` has none.
struct Direct {};

/// Of `hermite` [Sch06, ch. 3].
struct Hermite {
  double box_scale = 0;     ///< r
  double box_side = 0;      ///< r sqrt(2/sigma)
  int expansion_order = 0;  ///< p: terms an axis
  int neighbours = 0;       ///< n: boxes a side and axis that count; HermiteParameters::all_boxes if every box counts
  std::size_t boxes = 0;    ///< that hold sources
  double cost = 0;          ///< p^d N + (2n+1)^d p^d M [Sch06, 3.5]
};

/// Of `cells`.
struct Cells {
  double side = 0;           ///< of a cell
  int within_reach = 0;      ///< cells a side and axis in which sources count
  std::size_t occupied = 0;  ///< cells that hold sources
};

/// Of `outer_product`, which sorts sources into cells as `cells` does.
struct OuterProduct {
  double side = 0;           ///< of a cell
  int within_reach = 0;      ///< cells a side and axis in which sources count
  std::size_t occupied = 0;  ///< cells that hold sources
};

/// Of `chebyshev`.
struct Chebyshev {
  double box_side = 0;    ///< of the longest axis
  int nodes = 0;          ///< an axis of a box
  int neighbours = 0;     ///< boxes a side and axis that count
  std::size_t boxes = 0;  ///< that hold sources
};

/// Of `spread`.
struct Spread {
  double spacing = 0;      ///< of the lattice
  int window = 0;          ///< nodes an axis onto which a source is spread
  std::size_t bricks = 0;  ///< pieces of the lattice
};

/// The method that a Plan has chosen, its parameters, and what it promises and predicts.
struct Choice {
  Method method = Method::direct;  ///< never `automatic`
  double tolerance = 0;            ///< what was asked for; 0 if parameters were given by hand
  /// Proven error of one term, relative to |lambda| N_alpha, at the worst |alpha| <= derivative_order; none for r >= 1.
  std::optional<double> bound;
  double seconds = 0;                                                                ///< predicted, on one thread
  std::size_t sources = 0;                                                           ///< N
  std::size_t targets = 0;                                                           ///< that the prediction is for
  std::variant<Direct, Hermite, Cells, OuterProduct, Chebyshev, Spread> parameters;  ///< those of `method`
};

/// A parameter by its name, as in the structs above. A number without a bound is the text "all".
struct Parameter {
  std::string name;                                       ///< "spacing"
  std::variant<double, std::int64_t, std::string> value;  ///< a length or factor, a count, or a word
};

/// The parameters of the method as a list, for a program that prints them.
std::vector<Parameter> parameters(const Choice& choice);

/// One line: method, parameters, bound and predicted seconds.
std::ostream& operator<<(std::ostream& out, const Choice& choice);

// ---------------------------------------------------------------------------------------------------------------
// Bounds, public so that they can be tabulated

/// N_alpha = sigma^{|alpha|/2} sqrt(2^{|alpha|} alpha!): no value of D^alpha exp(-sigma r^2) is larger.
template <int d>
double derivative_scale(const Derivative<d>& alpha, double sigma);

/// Bound (3.5) of [Sch06, Satz 3.7.7] for one unit weight (Q_R = Q_A = 1), divided by sigma^{|alpha|/2}. There is none
/// unless r < 1 and p >= 2k - 1, with k the largest alpha_i.
/// @param r box_scale of HermiteParameters
/// @param p expansion_order
/// @param n neighbours; with all_boxes the first term, of neglected boxes, is absent
/// @param alpha the derivative
template <int d>
std::optional<double> hermite_bound(double r, int p, int n, const Derivative<d>& alpha);

/// Cost p^d N + (2n+1)^d p^d M of [Sch06, Lemma 3.5.1].
/// @param d dimension
/// @param p expansion_order
/// @param boxes_per_target (2n+1)^d, or the number of boxes where every box counts
/// @param sources N
/// @param targets M
double hermite_cost(int d, int p, double boxes_per_target, double sources, double targets);

// ---------------------------------------------------------------------------------------------------------------
// The plan

namespace detail {
template <int d>
class Engine;
}

/// A prepared sum.
///
/// Every single term lambda_j D^alpha exp(-sigma |y - x_j|^2) has at every target an error of at most
///
///     tolerance |lambda_j| N_alpha                                 everywhere, and
///     tolerance |lambda_j| N_alpha exp(L - sigma |y - x_j|^2)      beyond sigma |y - x_j|^2 = L = 2 ln(1/tolerance) + 40
///
/// with N_alpha of derivative_scale(). Rounding adds about 3e-14 N_alpha times the weight around the target. A combination
/// has sum |c_alpha| N_alpha in place of N_alpha. docs/fgtd.md, "The promise".
template <int d>
class Plan {
  static_assert(1 <= d && d <= 4, "fgtd: dimensions 1 to 4");

 public:
  /// Chooses a method and prepares it.
  /// @param sources  d x N, any N >= 0, finite
  /// @param weights  N x c: c columns that share sources and evaluation, finite
  /// @param sigma    > 0, in 1/length^2 of the sources; the Gaussian is exp(-sigma r^2), as in [Sch06]
  /// @param options  what is asked for
  /// @throws InvalidArgument   an argument breaks one of these rules
  /// @throws ToleranceError    the tolerance cannot be promised
  /// @throws MemoryLimitError  plan and evaluation would need more than Options::memory_limit
  /// @throws TimeLimitError    they are predicted to take longer than Options::most_seconds
  Plan(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights, double sigma,
       const Options& options = {});
  ~Plan();
  /// A plan can be moved; what is left can be assigned to or destroyed, nothing else.
  Plan(Plan&&) noexcept;
  /// The same.
  Plan& operator=(Plan&&) noexcept;

  /// D^alpha of the sum at scattered targets.
  /// @param targets  d x M, finite, anywhere, in the units of the sources
  /// @param alpha    the derivative; the sum itself by default
  /// @returns M x c
  /// @throws InvalidArgument   targets are not finite, or |alpha| is above Options::derivative_order
  /// @throws MemoryLimitError  the evaluation would need more than Options::memory_limit
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// The same on a tensor grid.
  /// @param grid   d axes of finite, ascending nodes
  /// @param alpha  the derivative; the sum itself by default
  /// @returns grid.size() x c, the first axis fastest
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const Derivative<d>& alpha = {}) const;

  /// Several linear combinations of derivatives in one pass: value and gradient, Laplacian, cutoff functions.
  /// @param targets       d x M, as of evaluate()
  /// @param combinations  each a list of derivatives with coefficients
  /// @returns M x (c * combinations.size()); the columns of the first combination come first
  /// @throws InvalidArgument, MemoryLimitError  as evaluate()
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  /// The same on a tensor grid, first axis fastest.
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;

  /// One combination; returns M x c.
  Eigen::MatrixXd evaluate_combination(const Eigen::Ref<const Points<d>>& targets,
                                       const Combination<d>& combination) const;
  /// The same on a tensor grid, first axis fastest.
  Eigen::MatrixXd evaluate_combination(const TensorGrid& grid, const Combination<d>& combination) const;

  /// Keeps sources and sigma, and takes other weights.
  /// @param weights  N x c, finite; c may be another than before
  /// @throws InvalidArgument, MemoryLimitError  as the constructor
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  /// What was chosen, and what it promises and predicts.
  const Choice& choice() const;

 private:
  std::unique_ptr<detail::Engine<d>> engine_;
};

namespace detail {
/// Matrices that the library allocates are freed by the program. How Eigen does that follows from the instruction set
/// and the sanitizers a file is compiled with; the library defines this function for its own way alone, so that a
/// program compiled in another way does not link, where it would corrupt the heap.
template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_fgtd();
namespace {
[[maybe_unused, gnu::used]] void (*const same_flags)() =
    &compile_with_the_same_march_and_sanitizer_flags_as_fgtd<EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;
}  // namespace
}  // namespace detail

extern template class Plan<1>;
extern template class Plan<2>;
extern template class Plan<3>;
extern template class Plan<4>;

}  // namespace fgtd
