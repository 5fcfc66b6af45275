// The copies of a box that lie beyond its faces, as Options::axes has them. Along each axis a coordinate is measured from
// a centre, u = x - centre, and the images of it lie at
//   periodic, mirrors   m L + s_m u for all whole m, s_m = -1 for mirrors and odd m, L the length of the box
//   a single mirror     u and -u, from the mirror
//   nothing beyond      u
// Those with |m| <= near are summed as sources, all others by their rest (rest.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "farfield/farfield.hpp"

namespace farfield::detail {

/// One axis of the box, where all of its points are known.
struct CopiedAxis {
  Ends ends = Ends::unbounded;
  double centre = 0;
  double length = 0;  // L; of a box that is not bounded: what the points need
  int near = 0;       // copies to each side that are sources

  bool repeats() const { return ends == Ends::periodic || ends == Ends::mirrors; }
  bool mirrors() const { return ends != Ends::periodic && ends != Ends::unbounded; }
  /// Differences of a target and an image of a source about the image's centre are at most this.
  double reach() const { return ends == Ends::mirror_low || ends == Ends::mirror_high ? 2 * length : length; }
  /// From an image to the next one that is not turned against it.
  double period() const { return ends == Ends::mirrors ? 2 * length : length; }

  bool operator==(const CopiedAxis&) const = default;
};

/// An image of all points: along axis l they lie at centre + shift[l] + sign[l] u.
struct Copy {
  std::array<double, 3> shift{};
  std::array<double, 3> sign{1, 1, 1};
  double charge = 1;  // of a source, in units of its own
};

/// Copies next to the box reach as far as this part of the longest reach of an axis: then 3 to 6 degrees of the rest make
/// a digit.
constexpr double good_distance = 0.8;

/// True if there is something beyond the ends of any axis.
bool has_copies(const Options& options);

/// Throws InvalidArgument if the axes of the options are none, or none whose images can be summed.
void check_axes(const Options& options, int dimension);

template <int d>
class Copies {
 public:
  /// `low`, `high`: extent of the points once they are in the box. Copies next to it reach as far as `distance` times the
  /// longest reach of an axis. Throws InvalidArgument if the box is so long, or cores so wide, that there are too many.
  Copies(const Options& options, const double* low, const double* high, double distance);

  const std::array<CopiedAxis, 3>& axes() const { return axes_; }
  /// The points themselves first.
  const std::vector<Copy>& near() const { return near_; }
  /// Signs of the images along the axes with mirrors; the charge that goes with them.
  const std::vector<Copy>& turned() const { return turned_; }
  /// There are copies without end.
  bool repeats() const { return axes_[0].repeats() || axes_[1].repeats() || axes_[2].repeats(); }

 private:
  std::array<CopiedAxis, 3> axes_{};
  std::vector<Copy> near_, turned_;
};

/// Where x lies in the box, and -1 if that is a mirror's image.
struct InBox {
  double x = 0;
  double sign = 1;
};
InBox in_box(const Axis& axis, double x);

}  // namespace farfield::detail
