// Cutoff functions zeta of order 2, 4, ...: each a combination of derivatives of Gaussians, so that the density of all
// blobs is one Gauss transform a width. method.md, section 3. Knows nothing about particles.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "base/named.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// A symmetric matrix of the dimension's size; what is beyond it is 0.
using Tensor = std::array<std::array<double, max_dimension>, max_dimension>;

/// coefficient * D^derivative exp(-|x|^2 / width^2), as long as it is round. An ellipse is
/// coefficient * D^derivative exp(-x^T (width^2 I + longer)^-1 x), with no negative eigenvalue of `longer` and one that
/// is 0: width is its shortest radius.
struct CutoffTerm {
  double width = 1;
  std::array<int, max_dimension> derivative{};
  double coefficient = 1;
  Tensor longer{};
  /// Radius of a sphere: |x| is then the chord, the straight line through the sphere between two of its points, and
  /// derivatives are those of the plane, of which all together depend on |x| alone. 0: there is no sphere.
  double sphere = 0;

  bool is_round() const { return longer == Tensor{}; }
};

/// zeta_eps as a sum of terms.
using Cutoff = std::vector<CutoffTerm>;

/// A cutoff as a case names it, `particles.cutoff = "..."`. method.md, equations 4 and 4a.
struct NamedCutoff {
  std::string_view name;
  std::string_view meaning;  // as of a NamedChoice: what it is, and its order
  int order = 2;             // moments 1 .. order - 1 vanish
  bool is_gaussian = false;  // it is G(x) = pi^{-d/2} exp(-|x|^2)
  /// Keys of [particles] that go with it: numbers with defaults, named as no other key there. Searches for good
  /// settings try only cutoffs without any.
  std::vector<NamedParameter> parameters = {};
  /// zeta_eps(x) = eps^-d zeta(x / eps) for core radius eps > 0, from complete arguments. Throws std::invalid_argument
  /// for arguments that problems() complains about.
  Cutoff (*make)(int dimension, double core_radius, const Arguments& arguments) = nullptr;
  /// What is wrong with complete arguments that are each in range.
  std::vector<Complaint> (*problems)(const Arguments& arguments) = nullptr;
};

/// In the order of docs/cases.md; the first is the default.
const std::vector<NamedCutoff>& cutoffs();

/// Throws std::out_of_range for an unknown name.
const NamedCutoff& find_cutoff(std::string_view name);

/// zeta_eps of that name, with defaults for what is not given. Throws as find_cutoff, complete and NamedCutoff::make do.
Cutoff make_cutoff(std::string_view name, int dimension, double core_radius, const Arguments& given = {});

/// zeta_eps(0), the largest |zeta_eps|: the Fourier transforms of all cutoffs are positive.
double peak(const Cutoff& cutoff);

/// The Fourier transform zeta_eps^(k), 1 at k = 0, for a wave vector k of this size along the first axis.
double fourier(const Cutoff& cutoff, int dimension, double wave_number);

/// The smallest of its widths.
double narrowest_width(const Cutoff& cutoff);

/// A distance beyond which no |zeta_eps| is larger than this part of its peak, 0 < part < 1.
double reach(const Cutoff& cutoff, double part);

/// The same function of |x| on a sphere of this radius, in 2D and of round terms; 0: the cutoff as it is. Its integral over
/// the sphere is that over the plane, but for what lies beyond the distance 2 radius. docs/method.md, section 18.
Cutoff on_sphere(Cutoff cutoff, double radius);

/// The cutoff convolved with the Gaussian of variance spread/2 an axis. The square of every width grows by `spread`.
/// Its integral and the coefficients of the derivatives stay (method.md, equation 11).
Cutoff spread_cutoff(const Cutoff& cutoff, int dimension, double spread);

/// The same with spread * shape in place of a spread that is the same along all axes: the largest eigenvalue of the shape
/// is 1, and the smallest is at least 0.
Cutoff spread_cutoff(const Cutoff& cutoff, int dimension, double spread, const Tensor& shape);

}  // namespace gaussdrift

namespace gaussdrift::base {
template <>
std::vector<NamedCutoff>& catalogue();
}
