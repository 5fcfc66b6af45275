// What all images of a charge beyond the nearest do at a place: the whole sum over the lattice, by Ewald's method [Ewa21],
// less the sources that are summed one by one. It is smooth wherever a target and an image of a source may lie.
#pragma once

#include <array>
#include <vector>

#include "farfield/images/copies.hpp"

namespace farfield::detail {

/// Potential and its gradient.
struct Smooth {
  double value = 0;
  std::array<double, 3> gradient{};
};

/// The images that are turned in one way. In 3D the potential of a charge is 1/r, in 2D -ln r.
///
/// Where all axes repeat, the mean of the whole potential over the box is 0, as a uniform background of the opposite charge
/// makes it. Where one axis of the plane repeats, the potential is -ln |2 sin(pi w / P)|, w = z_1 + i z_2: no background.
template <int d>
class LatticeSum {
 public:
  /// turned: see Copies::turned()
  LatticeSum(const std::array<CopiedAxis, 3>& axes, const Copy& turned);

  /// At z = target - image of the source, both from their centres; |z_l| <= axes[l].reach().
  Smooth at(const double* z) const;

  /// The Laplacian of the potential: that of the background.
  double laplacian() const { return laplacian_; }

 private:
  Smooth in_strip(const double* z) const;
  void add_images(const double* z, Smooth& sum) const;
  void make_waves();
  void add_waves(const double* z, Smooth& sum) const;
  /// First image along an axis and the step to the next, in lengths of the box.
  int first(std::size_t l, int most) const;
  int step(std::size_t l) const { return axes_[l].ends == Ends::mirrors ? 2 : 1; }

  std::array<CopiedAxis, 3> axes_;
  std::array<bool, 3> odd_{};  // images at odd multiples of the length alone
  double volume_ = 1;          // of a cell of the lattice
  double split_ = 0;           // Ewald's parameter
  double laplacian_ = 0;
  struct Wave {
    std::array<int, 3> number;
    double strength;
  };
  std::vector<Wave> waves_;
  std::array<int, 3> most_waves_{};
  int strip_ = -1;  // the one axis that repeats, in the plane
};

}  // namespace farfield::detail
