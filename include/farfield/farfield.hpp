/// @file
/// Sums for kernels that do not decay: the library farfield, whole.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// Sums over all pairs of points for kernels that do not decay: Coulomb in 2D and 3D, the logarithm in 1D and 2D, and
/// vortex blobs in 2D, directly or to a promised accuracy in linear time. docs/farfield.md explains the methods, the
/// promise and the costs. In short:
///
///     const farfield::Plan<3> plan(farfield::Kernel::coulomb, points, {.tolerance = 1e-6});
///     const farfield::Values<3> values = plan.evaluate(charges);   // values.potential, values.field
///
/// Bad input throws an Error. Nothing is printed, and there is no global state. Evaluation is const, and several threads
/// may call it at a time. Results do not depend on the number of threads.
namespace farfield {

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
/// The work would need more memory than Options::memory_limit; thrown before it is allocated.
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
/// A sum exceeds the range of double: charges too large, or points too close to each other.
class RangeError : public Error {
 public:
  /// Keeps what and where beside the message.
  RangeError(const std::string& message, const std::string& sum, std::size_t index)
      : Error(message), quantity(sum), target(index) {}
  std::string quantity;  ///< "potential" or "field"
  std::size_t target;    ///< its number, from 0; on several ranks that of `numbers`
};

// ---------------------------------------------------------------------------------------------------------------
// Arguments

/// Points as columns: d x m, so that a point's coordinates are contiguous.
template <int d>
using Points = Eigen::Matrix<double, d, Eigen::Dynamic>;

/// What a source at y_j with charge q_j does at a target x_i, r = |x_i - y_j|. Pairs at distance 0 are left out.
enum class Kernel {
  /// Charges that repel each other, without a factor 4 pi:
  ///
  ///     3D   potential   sum_j q_j / r       field  sum_j q_j (x_i - y_j) / r^3
  ///     2D   potential  -sum_j q_j ln r      field  sum_j q_j (x_i - y_j) / r^2
  coulomb,
  /// The logarithm and its gradient, in 1D and 2D:
  ///
  ///     potential  sum_j q_j ln r            field  sum_j q_j (x_i - y_j) / r^2
  log,
  /// The velocity of vortex blobs in 2D, with circulations q_j and eps = Options::core_radius. There is no potential.
  ///
  ///     field  sum_j q_j (1 - exp(-r^2/eps^2)) / (2 pi r^2) (-dy, dx),      (dx, dy) = x_i - y_j
  vortex_blob
};

/// How the sums are computed; docs/farfield.md, "Methods".
enum class Method {
  automatic,  ///< the method with the smallest predicted time
  direct,     ///< every pair
  tree,       ///< groups of sources are replaced by substitute charges, which act on every target
  symmetric   ///< groups of targets are replaced as well: linear time
};

/// Every kernel.
const std::vector<Kernel>& kernels();
/// Every method, `automatic` first.
const std::vector<Method>& methods();

/// The name as it is written in files: "coulomb", "log", "vortex-blob".
std::string to_string(Kernel kernel);
/// The name as it is written in files: "auto", "direct", "tree", "symmetric".
std::string to_string(Method method);

/// How the method sums and when it is good, in one line.
std::string meaning(Method method);

/// What lies beyond the ends of an axis; docs/farfield.md, "Periodic boxes and mirrors".
enum class Ends {
  unbounded,   ///< nothing
  periodic,    ///< copies of all points, shifted by high - low, without end
  mirrors,     ///< mirrored copies at `low` and at `high`, and their mirror images, without end
  mirror_low,  ///< one mirrored copy, at `low`; `high` is not looked at
  mirror_high  ///< one mirrored copy, at `high`; `low` is not looked at
};

/// One axis of the box, in the units of the points.
struct Axis {
  Ends ends = Ends::unbounded;  ///< what is beyond it
  double low = 0;               ///< where the box begins
  double high = 0;              ///< where it ends; > low where both count
};

/// The charge of a mirror image.
enum class MirrorImages {
  equal,    ///< that of the source: the field of charges does not cross the mirror
  opposite  ///< its opposite: the velocity of vortices does not cross the mirror, and the potential of charges is 0 on it
};

/// What a Plan is asked for. The defaults are valid.
struct Options {
  double tolerance = 1e-6;                          ///< see Plan; smallest_tolerance <= tolerance < 1
  Method method = Method::automatic;                ///< how
  int threads = 0;                                  ///< 0: all
  double core_radius = 0;                           ///< eps of vortex_blob; > 0 there
  bool potential = true;                            ///< false: the field alone; spares the logarithms in 1D and 2D
  std::size_t memory_limit = std::size_t{8} << 30;  ///< bytes that plan and evaluation may hold together
  double most_seconds = std::numeric_limits<double>::infinity();  ///< that may be predicted, for one thread
  std::size_t leaf_size = 0;  ///< clusters of more points are divided; 0: chosen by the predicted time
  /// What is beyond the ends of each axis; d = 2, 3, and one process. In 3D all three axes are periodic or between two
  /// mirrors, or none is.
  std::array<Axis, 3> axes{};
  MirrorImages mirror_images = MirrorImages::equal;  ///< charges of mirror images
};

/// Tolerances below are not promised by `tree` and `symmetric`; `direct` is then taken by `automatic`.
constexpr double smallest_tolerance = 1e-11;
/// Tolerances below are not promised where an axis has copies without end: Ends::periodic and Ends::mirrors.
constexpr double smallest_folded_tolerance = 1e-11;

/// How many copies of the sources a Plan with these options sums as sources, their own among them, for points that fill the
/// box of Options::axes; along an axis that is not bounded they are taken to reach as far as along the longest that is.
/// More are summed for tolerances below 1e-8 and for blobs with wide cores.
/// @throws InvalidArgument, ToleranceError  as a Plan
template <int d>
std::size_t near_copies(const Options& options);
extern template std::size_t near_copies<2>(const Options& options);  ///< in the plane
extern template std::size_t near_copies<3>(const Options& options);  ///< in space

// ---------------------------------------------------------------------------------------------------------------
// Results

/// What an evaluation returns.
template <int d>
struct Values {
  Eigen::VectorXd potential;  ///< of every target; empty for vortex_blob and without Options::potential
  Points<d> field;            ///< d x targets
};

/// What one evaluation does, counted.
struct Work {
  double pairs = 0;             ///< of a source and a target
  double substitute_pairs = 0;  ///< of a substitute charge and a target, or of a source and a substitute target
  double couplings = 0;         ///< of two clusters
};

/// Where the seconds of one evaluation went.
struct Seconds {
  double forward = 0;   ///< from charges to clusters
  double coupling = 0;  ///< between clusters
  double backward = 0;  ///< from clusters to targets
  double leaves = 0;    ///< pair by pair; in `tree` also the substitute charges, in `direct` everything
};

/// The method that a Plan has chosen, its parameters, and what it promises and predicts.
struct Choice {
  Kernel kernel = Kernel::coulomb;  ///< that was asked for
  Method method = Method::direct;   ///< never `automatic`
  double tolerance = 0;             ///< what was asked for
  double bound = 0;    ///< what the promise holds with in place of tolerance (see Plan); <= tolerance unless `direct`
  double seconds = 0;  ///< predicted for one evaluation and its share of the plan, one thread
  std::size_t sources = 0;    ///< N
  std::size_t targets = 0;    ///< M
  Work work;                  ///< of one evaluation
  int degree = 0;             ///< tree, symmetric: highest degree of the interpolating polynomials
  std::size_t leaf_size = 0;  ///< tree, symmetric: clusters of more points are divided
  std::size_t clusters = 0;   ///< tree, symmetric: of all levels
  int levels = 0;             ///< tree, symmetric: of the tree
  std::size_t copies = 1;     ///< of the sources, that are summed as sources: their own, and those next to the box
  int rest_degree = 0;        ///< of the polynomial for all other copies; 0: there are no others
};

/// One line: method, parameters, bound and predicted seconds.
std::ostream& operator<<(std::ostream& out, const Choice& choice);

// ---------------------------------------------------------------------------------------------------------------
// Several processes

/// What a Plan whose points are on several processes, its ranks, needs of them. Over MPI these are calls of
/// MPI_Comm_rank, MPI_Comm_size, MPI_Alltoallv and MPI_Allreduce. All ranks call a function that communicates in the
/// same order, one thread of each.
class Ranks {
 public:
  /// Bytes on their way.
  using Bytes = std::vector<std::byte>;
  virtual ~Ranks() = default;
  /// Which of them this one is, from 0.
  virtual int rank() const = 0;
  /// How many there are.
  virtual int size() const = 0;
  /// out[r] goes to rank r; what came from rank r is in result[r]. `out` has size() entries.
  virtual std::vector<Bytes> exchange(std::vector<Bytes> out) = 0;
  /// Each number becomes its sum over all ranks.
  virtual void sum(std::span<std::int64_t> numbers) = 0;
  /// Each number becomes its maximum over all ranks. None is a NaN.
  virtual void max(std::span<double> numbers) = 0;
};

/// Bytes that a rank receives from others for a Plan on several ranks and one evaluation.
struct Received {
  double points = 0;   ///< places, charges and results of points that another rank sums for
  double tree = 0;     ///< clusters of other ranks, and which moments and points others want
  double moments = 0;  ///< of clusters of other ranks
  double near = 0;     ///< places and charges of points near those that this rank sums for
};

// ---------------------------------------------------------------------------------------------------------------
// The plan

namespace detail {
template <int d>
class Evaluator;
}

/// Sums for fixed points and any charges. What is promised, for all points, all charges and every target i, with f~ the
/// computed and f the exact field, phi the potential, and sums over all sources j at r_ij > 0:
///
///     |f_i - f~_i|      <= tolerance sum_j |q_j| / r_ij^(d-1)        (vortex_blob: 1 / (2 pi) of that)
///     |phi_i - phi~_i|  <= tolerance sum_j |q_j| / r_ij              in 3D
///     |phi_i - phi~_i|  <= tolerance sum_j |q_j| (1 + |ln r_ij|)     in 1D and 2D
///
/// where d - 1 is 1 in 1D too. It holds target by target and charge by charge, so neither cancellation nor a crowd of
/// targets at the worst place weakens it, and so it holds in every norm over the targets. Rounding adds about 1e-15
/// times the same sums. The error of a charge at a target is a measured one: docs/farfield.md, "The promise".
template <int d>
class Plan {
  static_assert(1 <= d && d <= 3, "farfield: dimensions 1 to 3");

 public:
  /// Chooses a method and prepares it.
  /// @param kernel   coulomb: d = 2, 3; log: d = 1, 2; vortex_blob: d = 2
  /// @param sources  d x N, any N >= 0, finite
  /// @param targets  d x M, any M >= 0, finite, in the units of the sources
  /// @param options  what is asked for
  /// @throws InvalidArgument   an argument breaks one of these rules
  /// @throws ToleranceError    the tolerance cannot be promised
  /// @throws MemoryLimitError  plan and evaluation would need more than Options::memory_limit
  /// @throws TimeLimitError    they are predicted to take longer than Options::most_seconds
  Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>& targets,
       const Options& options = {});
  /// The sources are the targets.
  Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& points, const Options& options = {});
  /// The sources are the targets, and each rank has some of them. Results are those of one plan for the points of all
  /// ranks in the order of their numbers, to the last bit. All ranks make the plan, evaluate it and destroy it together;
  /// evaluate() takes the charges of a rank's own points and returns their values. An Error of one rank is thrown by all.
  /// Anything else, as std::bad_alloc, is thrown by the rank that it happens on, and others wait for that rank.
  /// @param kernel   as above
  /// @param points   those of this rank, maybe none
  /// @param numbers  of these points, in any order; different for all points of all ranks
  /// @param options  the same on all ranks, but for threads and memory_limit
  /// @param ranks    must outlive the plan
  Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& points, std::span<const std::int64_t> numbers,
       const Options& options, Ranks& ranks);
  ~Plan();
  /// A plan can be moved; what is left can be assigned to or destroyed, nothing else.
  Plan(Plan&&) noexcept;
  /// The same.
  Plan& operator=(Plan&&) noexcept;

  /// Potential and field of the charges at every target.
  /// @param charges  N, finite
  /// @param seconds  told where the time went, if it is not null
  /// @throws InvalidArgument   there is not one finite charge a source
  /// @throws MemoryLimitError  the evaluation would need more than Options::memory_limit
  /// @throws RangeError        a sum exceeds the range of double
  Values<d> evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds* seconds = nullptr) const;

  /// What was chosen, and what it promises and predicts; the same on all ranks.
  const Choice& choice() const;

  /// What this rank receives from others; nothing if there are none.
  Received received() const;

 private:
  std::unique_ptr<detail::Evaluator<d>> evaluator_;
};

namespace detail {
/// As in fgtd: Eigen's way of allocating follows from the flags a file is compiled with; a program compiled in another
/// way than the library does not link, where it would corrupt the heap.
template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_farfield();
namespace {
[[maybe_unused, gnu::used]] void (*const same_flags)() = &compile_with_the_same_march_and_sanitizer_flags_as_farfield<
    EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;
}  // namespace
}  // namespace detail

extern template class Plan<1>;
extern template class Plan<2>;
extern template class Plan<3>;

}  // namespace farfield
