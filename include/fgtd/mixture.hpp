/// @file
/// Sums of several Gaussians of one radial function, over the same sources: part of the library fgtd.
#pragma once

#include <cstddef>
#include <fgtd/fgtd.hpp>
#include <memory>
#include <vector>

namespace fgtd {

/// One Gaussian of a mixture: coefficient exp(-sigma r^2).
struct Gaussian {
  double sigma = 1;         ///< > 0, in 1/length^2 of the sources
  double coefficient = 1;   ///< its factor
  double tolerance = 1e-6;  ///< of its terms, as Options::tolerance is: relative to |coefficient|
};

namespace detail {
template <int d>
class MixtureEngine;
}

/// A prepared sum over sources of several Gaussians, and of its derivatives:
///
///     s_alpha(y) = D^alpha sum_k coefficient_k sum_j lambda_j exp(-sigma_k |y - x_j|^2)
///
/// Gaussian k adds an error of at most tolerance_k |coefficient_k| |lambda_j| N_alpha(sigma_k) for each source, at every
/// target; N_alpha is derivative_scale(). Rounding adds about 3e-14 of the same numbers.
///
/// Gaussians of similar widths share a lattice: sources are spread to it and targets read from it once for all of them,
/// where a Plan for each would do so every time. docs/fgtd.md, "Several Gaussians".
template <int d>
class Mixture {
  static_assert(1 <= d && d <= 4, "fgtd: dimensions 1 to 4");

 public:
  /// Decides which Gaussians share a lattice, by predicted cost, and prepares the sums.
  /// @param sources    d x N, any N >= 0, finite
  /// @param weights    N x c, finite
  /// @param gaussians  any number of them, in any order
  /// @param options    what is asked for; tolerance and `hermite` are not looked at, and a named method is that of all,
  ///                   which then share nothing
  /// @throws InvalidArgument, ToleranceError, MemoryLimitError, TimeLimitError  as Plan
  Mixture(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
          std::vector<Gaussian> gaussians, const Options& options = {});
  ~Mixture();
  /// A mixture can be moved; what is left can be assigned to or destroyed, nothing else.
  Mixture(Mixture&&) noexcept;
  /// The same.
  Mixture& operator=(Mixture&&) noexcept;

  /// Several linear combinations of derivatives at scattered targets.
  /// @param targets       d x M, finite, anywhere
  /// @param combinations  each a list of derivatives with coefficients
  /// @returns M x (c * combinations.size()); the columns of the first combination come first
  /// @throws InvalidArgument, MemoryLimitError  as Plan
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  /// The same on a tensor grid, first axis fastest.
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;

  /// Keeps sources and Gaussians, and takes other weights.
  /// @param weights  N x c, finite; c may be another than before
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  /// What was chosen for each Gaussian, in the order they were given. Its seconds are its part of those of its group.
  const std::vector<Choice>& choices() const;
  /// The number of the lattice or method of its own that each Gaussian has, from 0.
  const std::vector<std::size_t>& groups() const;

 private:
  std::unique_ptr<detail::MixtureEngine<d>> engine_;
};

extern template class Mixture<1>;
extern template class Mixture<2>;
extern template class Mixture<3>;
extern template class Mixture<4>;

}  // namespace fgtd
