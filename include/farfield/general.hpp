/// @file
/// Sums for any kernel that is smooth away from r = 0, by interpolation and recompression: the H2 matrices of farfield.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "farfield/farfield.hpp"

/// For kernels beyond those of farfield.hpp; docs/farfield.md, "General kernels", explains method, promise and costs.
///
///     const auto yukawa = farfield::KernelFunction::yukawa(2.0);
///     const farfield::GeneralPlan<3> plan(yukawa, points, {.tolerance = 1e-6});
///     const Eigen::VectorXd sums = plan.evaluate(charges);   // sum_j q_j exp(-2 r_ij) / r_ij
namespace farfield {

namespace detail {
struct KernelData;
template <int d>
class GeneralEngine;
}  // namespace detail

/// A kernel k(x - y). Where its value at distance 0 is finite, a pair at distance 0 counts with that value. Where it is
/// not, as of 1/r, the pair is left out.
class KernelFunction {
 public:
  /// values[i] = k(distance[i]) for i < count. It is called from several threads at a time, must return the same bits for
  /// the same distance, and may be called with distance 0.
  using OfDistance = std::function<void(const double* distance, std::size_t count, double* values)>;
  /// The same for k(difference), difference[l][i] = coordinate l of target minus source.
  using OfDifference = std::function<void(const double* const* difference, std::size_t count, double* values)>;

  /// exp(-lambda r) / r, lambda >= 0
  static KernelFunction yukawa(double lambda);
  /// 1 / r^power, 1 <= power <= 12
  static KernelFunction inverse_power(int power);
  /// exp(-sigma r^2), sigma > 0
  static KernelFunction gaussian(double sigma);
  /// A kernel of the distance.
  /// @param function     its values at some distances
  /// @param nanoseconds  that a value takes, roughly; it decides how large the near field is
  static KernelFunction of_distance(OfDistance function, double nanoseconds = 10);
  /// As of_distance(). Nothing is known of its symmetries, so that more matrices are kept.
  static KernelFunction of_difference(OfDifference function, double nanoseconds = 10);

  /// For those who look inside.
  const detail::KernelData& data() const { return *data_; }

 private:
  explicit KernelFunction(std::shared_ptr<const detail::KernelData> data) : data_(std::move(data)) {}
  std::shared_ptr<const detail::KernelData> data_;
};

/// How a GeneralPlan sums.
enum class GeneralMethod {
  automatic,     ///< the one whose predicted time is smaller
  direct,        ///< every pair
  interpolation  ///< an H2 matrix
};

/// Every method, `automatic` first.
const std::vector<GeneralMethod>& general_methods();

/// The name as it is written in files: "auto", "direct", "interpolation".
std::string to_string(GeneralMethod method);

/// What it does, in a line.
std::string meaning(GeneralMethod method);

/// What a GeneralPlan is asked for. The defaults are valid.
struct GeneralOptions {
  double tolerance = 1e-6;                          ///< see GeneralPlan; 1e-10 <= tolerance < 1
  GeneralMethod method = GeneralMethod::automatic;  ///< how
  int threads = 0;                                  ///< 0: all
  /// Clusters are admissible if their diameter is at most eta times their distance. Cubes being whole sides apart, that
  /// is 1, 2, 3 or 4 sides. 0: chosen, sqrt(d)
  double eta = 0;
  std::size_t leaf_size = 0;   ///< pairs of clusters with more points than its square are divided; 0: chosen
  bool recompress = true;      ///< false: tensor products of Chebyshev polynomials as they are
  bool variable_order = true;  ///< false: the highest order that a level needs is that of all levels
  std::size_t memory_limit = std::size_t{8} << 30;  ///< bytes that plan and evaluation may hold together
};

/// One level of the tree of clusters, from the root.
struct GeneralLevel {
  int level = 0;              ///< 0: the root
  double side = 0;            ///< of its cubes
  int order = 0;              ///< degree of the polynomials
  std::size_t functions = 0;  ///< polynomials a cluster, before recompression
  std::size_t rank = 0;       ///< functions a cluster, after it
  std::size_t clusters = 0;   ///< that have a basis
  std::size_t couplings = 0;  ///< pairs of clusters
  std::size_t matrices = 0;   ///< different coupling matrices
  double mean_rank = 0;       ///< of the couplings: root of the mean square
  double far_pairs = 0;       ///< pairs of points that its couplings stand for
};

/// What a GeneralPlan has chosen, keeps and measured.
struct GeneralChoice {
  GeneralMethod method = GeneralMethod::direct;  ///< never automatic
  double tolerance = 0;                          ///< what was asked for
  double kernel_size = 0;                        ///< K of the promise
  double measured = 0;       ///< error that the promise bounds by tolerance, estimated on `compared` targets; 0: direct
  std::size_t compared = 0;  ///< targets
  std::size_t sources = 0;   ///< N
  std::size_t targets = 0;   ///< M
  int separation = 0;        ///< sides between admissible cubes
  double pairs = 0;          ///< summed one by one
  std::size_t clusters = 0;  ///< of all levels
  std::vector<GeneralLevel> levels;  ///< from the root
  double basis_bytes = 0;            ///< leaf matrices and transfer matrices
  double coupling_bytes = 0;         ///< coupling matrices
  double list_bytes = 0;             ///< points, clusters and lists of blocks
  double build_seconds = 0;          ///< that the plan took
};

/// One line: method, storage, ranks and error.
std::ostream& operator<<(std::ostream& out, const GeneralChoice& choice);

/// Where the seconds of one evaluation went.
struct GeneralSeconds {
  double forward = 0;   ///< charges to coefficients of clusters
  double coupling = 0;  ///< coefficients of clusters to those of others
  double backward = 0;  ///< coefficients to values at points
  double near = 0;      ///< pairs one by one
};

/// f_i = sum_j q_j k(x_i - y_j) for fixed points and any charges, in 2 or 3 dimensions. What is promised, with f~ the
/// computed sums, over all M targets and N sources:
///
///     sqrt(mean_i |f_i - f~_i|^2)  <=  tolerance K sqrt(N sum_j q_j^2)
///
/// K = choice().kernel_size is the mean of |k| over all sources and some 128 targets, of which the tenth that sees most is
/// left out. For charges of equal size the right side is tolerance times a typical target's sum of |q_j k|. This follows
/// from the norm of the error of the matrix, which the plan measures; a kernel that breaks it is refused. Rounding adds
/// about 1e-15 times the sums of |q_j k|. Results do not depend on the number of threads.
template <int d>
class GeneralPlan {
  static_assert(d == 2 || d == 3, "farfield: general kernels are for dimensions 2 and 3");

 public:
  /// Prepares the sum.
  /// @param kernel   k
  /// @param sources  d x N, any N >= 0, finite
  /// @param targets  d x M, any M >= 0, finite, in the units of the sources
  /// @param options  what is asked for
  /// @throws InvalidArgument   an argument breaks one of these rules, or a value of the kernel is not finite at r > 0
  /// @throws ToleranceError    the kernel is not smooth enough for the tolerance
  /// @throws MemoryLimitError  plan and evaluation would need more than GeneralOptions::memory_limit
  GeneralPlan(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& sources,
              const Eigen::Ref<const Points<d>>& targets, const GeneralOptions& options = {});
  /// The sources are the targets.
  GeneralPlan(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& points,
              const GeneralOptions& options = {});
  ~GeneralPlan();
  /// A plan can be moved; what is left can be assigned to or destroyed, nothing else.
  GeneralPlan(GeneralPlan&&) noexcept;
  /// The same.
  GeneralPlan& operator=(GeneralPlan&&) noexcept;

  /// The sums at all targets.
  /// @param charges  N, finite
  /// @param seconds  told where the time went, if it is not null
  /// @throws InvalidArgument  there is not one finite charge a source
  /// @throws RangeError       a sum exceeds the range of double
  Eigen::VectorXd evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, GeneralSeconds* seconds = nullptr) const;

  /// What was chosen, and what was measured.
  const GeneralChoice& choice() const;

 private:
  std::unique_ptr<detail::GeneralEngine<d>> engine_;
};

extern template class GeneralPlan<2>;
extern template class GeneralPlan<3>;

}  // namespace farfield
