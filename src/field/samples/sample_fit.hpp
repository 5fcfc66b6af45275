// Functions through values at scattered points, by radial basis functions (docs/rbf.md): what `samples` of a density or
// a velocity become.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "field/fit_errors.hpp"
#include "field/gridded/grid_data.hpp"
#include "gaussdrift/points.hpp"
#include "rbf/generalized.hpp"
#include "rbf/interpolant.hpp"

namespace gaussdrift {

/// Names of the kernels, as in a case.
std::vector<std::string_view> sample_kernel_names();

/// Ways to choose the width.
std::vector<std::string_view> width_by_names();

/// The kernel with the smallest errors for smooth functions at random points: "matern52" where the equations are solved
/// directly, "matern32" beyond, since the iteration needs a better condition.
std::string default_sample_kernel(std::size_t samples);
/// So many are solved directly.
constexpr std::size_t most_dense_samples = 2500;

/// Least number of samples: fewer do not tell how a function changes along every axis.
constexpr std::size_t least_samples(int dimension) { return static_cast<std::size_t>(dimension) + 2; }

/// Samples of a velocity with divergence_free: its equations are dense, with so many components in all.
constexpr std::size_t most_divergence_free_samples(int dimension) {
  return static_cast<std::size_t>(rbf::most_generalized) / static_cast<std::size_t>(dimension);
}

struct SampleFitOptions {
  std::string kernel = {};       // empty: default_sample_kernel()
  double width = 0;              // shape of the kernel; 0: chosen
  std::string width_by = {};     // one of width_by_names(); empty: by left-out samples
  double regularisation = 0;     // added to the diagonal of the equations, in units of the kernel's values
  bool divergence_free = false;  // of a velocity: as many components as dimensions
  int threads = 0;               // 0: all
};

/// A function with one or several components, ready to be evaluated, and facts about it. Immutable.
struct SampleFit {
  using Function = std::variant<rbf::Interpolant<2>, rbf::Interpolant<3>, rbf::DivergenceFreeInterpolant<2>,
                                rbf::DivergenceFreeInterpolant<3>>;

  int dimension = 2;
  Function function;
  rbf::FitReport report;
  bool width_was_chosen = false;
  Vector low{}, high{};      // where it stands for the samples: the box around them, and one spacing more
  double largest = 0;        // of the samples: |value|, or the length of a vector
  double typical_error = 0;  // root mean square of the errors of left-out samples; of vectors, of their lengths
  double largest_error = 0;  // of a left-out sample
  FitErrors errors = {};     // of left-out samples, each at its place

  bool is_divergence_free() const { return function.index() >= 2; }
  /// Are its second derivatives continuous, at the samples too?
  bool is_smooth() const;
};

/// positions  [point][dimension], at least least_samples();  values  [point][component]
/// Throws InputError, in the words of a case, if there is no fit.
SampleFit fit_samples(int dimension, const std::vector<double>& positions, const std::vector<double>& values,
                      const SampleFitOptions& options);

/// The integral of the first component over a box, cut to that of the fit.
struct SampleIntegral {
  double value = 0, error = 0;
};
/// Throws rbf::Error where the kernel has no sum of Gaussians on so large a range. Not for fields without divergence.
SampleIntegral integral_of(const SampleFit& fit, const Vector& low, const Vector& high);

/// "matern52 of width 0.36 (chosen) to 2000 samples; left-out samples follow from the others to 1.3e-05 ...".
std::string describe(const SampleFit& fit);

/// What holds outside the box of a fit: which of some points are inside, and where the others take their values.
class SampleBox {
 public:
  SampleBox(const SampleFit& fit, Outside outside);

  /// Where values are taken for points: coordinates of `count` of them [axis][point], and which they are.
  struct Placed {
    std::array<std::vector<double>, max_dimension> axis;
    std::vector<std::size_t> index;
    std::vector<std::size_t> lost;  // points without a value, not finite
  };
  Placed place(const PointsView& x) const;
  /// False where `clamp` moves a point along this axis: values there do not change along it.
  bool varies(int axis, double coordinate) const;
  Outside outside() const { return outside_; }
  /// "x = 1.3 is outside of the samples, ..."; empty where there is a value.
  std::string why_lost(const Vector& x) const;

 private:
  int dimension_;
  Vector low_, high_;
  Outside outside_;
};

}  // namespace gaussdrift
