// fgtd: sums of Gaussians and of their derivatives, s_alpha(y) = D^alpha sum_j lambda_j exp(-sigma |y - x_j|^2),
// in d = 1, 2, 3, 4 dimensions, to a promised accuracy. docs/fgtd.md explains methods, promise and costs.
//
//   const fgtd::Plan<2> plan(sources, weights, sigma, {.tolerance = 1e-8, .derivative_order = 1});
//   const Eigen::MatrixXd values = plan.evaluate(targets, {0, 1});
//
// Everything throws fgtd::Error (below) on bad input, prints nothing and keeps no global state. Evaluation is const
// and safe to call from several threads. Results do not depend on the number of threads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

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
  MemoryLimitError(const std::string& message, double needed_bytes, std::size_t limit_bytes)
      : Error(message), needed(needed_bytes), limit(limit_bytes) {}
  double needed;
  std::size_t limit;
};

enum class Method;
/// The work is predicted to take longer than Options::most_seconds; thrown before it is begun.
class TimeLimitError : public Error {
 public:
  TimeLimitError(const std::string& message, double predicted, Method chosen)
      : Error(message), seconds(predicted), method(chosen) {}
  double seconds;  // on one thread
  Method method;
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
  Derivative<d> derivative{};
  double coefficient = 1;
};

/// A linear differential operator: Laplacian, cutoff function, one component of a gradient.
template <int d>
using Combination = std::vector<Term<d>>;

/// A tensor grid: one ascending node list per axis. Values on it run with the first axis fastest.
struct TensorGrid {
  std::vector<std::vector<double>> axes;

  std::size_t size() const {
    std::size_t product = axes.empty() ? 0 : 1;
    for (const auto& nodes : axes) product *= nodes.size();
    return product;
  }
};

/// How the sum is computed, see docs/fgtd.md. `automatic` takes the smallest predicted cost whose bound meets the tolerance.
enum class Method { automatic, direct, hermite, cells, outer, chebyshev, spread };

/// Every method, `automatic` first.
const std::vector<Method>& methods();

/// The name as it is written in files: "auto", "direct", "hermite", "cells", "outer", "chebyshev", "spread".
std::string to_string(Method method);

/// Parameters of `hermite` set by hand, as in the thesis [Sch06, ch. 3]; the accuracy is then bound (3.5) and nothing
/// else.
struct HermiteParameters {
  double box_scale = 0.5;      // r: boxes have the side r sqrt(2/sigma); bound (3.5) needs r < 1
  int expansion_order = 9;     // p: terms an axis
  int neighbours = all_boxes;  // n: boxes a side and axis that count; all_boxes: every box

  static constexpr int all_boxes = -1;
};

struct Options {
  double tolerance = 1e-6;            // of each Gaussian term, see Plan; smallest_tolerance <= tolerance < 1
  int derivative_order = 0;           // highest |alpha| that evaluate() can return; above 12 for tolerance <= 1e-4
  Method method = Method::automatic;  //
  int threads = 0;                    // 0: all
  std::size_t memory_limit = std::size_t{8} << 30;                // bytes that plan and evaluation may hold together
  double most_seconds = std::numeric_limits<double>::infinity();  // that may be predicted, for one thread

  // What will be evaluated, for the prediction of cost only; other targets stay possible.
  std::size_t expected_targets = 0;              // scattered; 0: as many as sources
  std::optional<TensorGrid> expected_grid = {};  // takes precedence over expected_targets

  std::optional<HermiteParameters> hermite = {};  // by hand; implies Method::hermite
};

/// Tolerances below cannot be promised in double precision.
constexpr double smallest_tolerance = 1e-14;

// ---------------------------------------------------------------------------------------------------------------
// What was chosen

struct Choice {
  Method method = Method::direct;
  double tolerance = 0;         // what was asked for; 0 if parameters were given by hand
  std::optional<double> bound;  // proven error of one term, relative to |lambda| N_alpha, worst |alpha| <=
                                // derivative_order; none for r >= 1
  double cost = 0;     // hermite: p^d N + (2n+1)^d p^d M [Sch06, 3.5]; else in pairs of `direct`. For comparison only
  double seconds = 0;  // the same predicted in seconds on one thread
  std::size_t sources = 0;
  std::size_t targets = 0;  // that the prediction is for
  // hermite only
  double box_scale = 0;     // r
  double box_side = 0;      // r sqrt(2/sigma)
  int expansion_order = 0;  // p
  int neighbours = 0;       // n; HermiteParameters::all_boxes if every box counts
  std::size_t boxes = 0;    // occupied
};

std::ostream& operator<<(std::ostream& out, const Choice& choice);

// ---------------------------------------------------------------------------------------------------------------
// Bounds, public so that they can be tabulated

/// N_alpha = sigma^{|alpha|/2} sqrt(2^{|alpha|} alpha!): no value of D^alpha exp(-sigma r^2) is larger.
template <int d>
double derivative_scale(const Derivative<d>& alpha, double sigma);

/// Bound (3.5) of [Sch06, Satz 3.7.7] for one unit weight (Q_R = Q_A = 1), divided by sigma^{|alpha|/2}; r < 1, p >= 2k
/// - 1 with k the largest alpha_i, else none. With n = all_boxes the first term (neglected boxes) is absent.
template <int d>
std::optional<double> hermite_bound(double r, int p, int n, const Derivative<d>& alpha);

/// Cost p^d N + (2n+1)^d p^d M of [Sch06, Lemma 3.5.1]; with every box counted, `boxes_per_target` replaces (2n+1)^d.
double hermite_cost(int d, int p, double boxes_per_target, double sources, double targets);

// ---------------------------------------------------------------------------------------------------------------
// The plan

namespace detail {
template <int d>
class Engine;
}

/// A prepared sum. With `tolerance` given, every single term lambda_j D^alpha exp(-sigma |y - x_j|^2) is right to
/// within tolerance |lambda_j| N_alpha at every target, and beyond sigma |y - x_j|^2 = L = 2 ln(1/tolerance) + 40 to
/// within tolerance |lambda_j| N_alpha exp(L - sigma |y - x_j|^2); rounding adds about 3e-14 N_alpha times the weight
/// around the target. A combination has sum |c_alpha| N_alpha in place of N_alpha.
template <int d>
class Plan {
  static_assert(1 <= d && d <= 4, "fgtd: dimensions 1 to 4");

 public:
  /// sources  d x N   any N >= 0, finite
  /// weights  N x c   c columns that share sources and evaluation, finite
  /// sigma            > 0; the Gaussian is exp(-sigma r^2), as in [Sch06]
  /// Throws InvalidArgument, ToleranceError, MemoryLimitError.
  Plan(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights, double sigma,
       const Options& options = {});
  ~Plan();
  Plan(Plan&&) noexcept;
  Plan& operator=(Plan&&) noexcept;

  /// D^alpha of the sum at scattered targets (d x M, anywhere). Returns M x c.
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// The same on a tensor grid, first axis fastest. Returns grid.size() x c.
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const Derivative<d>& alpha = {}) const;

  /// Several linear combinations of derivatives in one pass: value and gradient, Laplacian, cutoff functions.
  /// Returns M x (c * combinations.size()); the columns of the first combination come first.
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;

  /// One combination. Returns M x c.
  Eigen::MatrixXd evaluate_combination(const Eigen::Ref<const Points<d>>& targets,
                                       const Combination<d>& combination) const;
  Eigen::MatrixXd evaluate_combination(const TensorGrid& grid, const Combination<d>& combination) const;

  /// Same points and sigma, new weights (N x c; c may change).
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

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
