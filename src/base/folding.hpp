// A box whose faces are mirrors, or where what goes out at one side comes in at the other: all of space consists of
// copies of it, and a place in any copy is a place in the box. docs/method.md, section 12.
#pragma once

#include <array>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// What one axis of the box does.
struct FoldedAxis {
  bool periodic = false;
  bool mirror_low = false, mirror_high = false;  // not where it is periodic
  double low = 0, high = 0;

  bool folds() const { return periodic || mirror_low || mirror_high; }
};

/// A coordinate in the box, and its sign: -1 in copies that are mirrored along this axis.
struct Folded {
  double x = 0;
  double sign = 1;
};

class Folding {
 public:
  Folding() = default;
  explicit Folding(const std::array<FoldedAxis, max_dimension>& axes) : axes_(axes) {}

  const FoldedAxis& axis(int k) const { return axes_[static_cast<std::size_t>(k)]; }
  /// True if any axis folds.
  bool folds() const { return axes_[0].folds() || axes_[1].folds() || axes_[2].folds(); }

  /// The coordinate in the box. Exactly the same where it lies there; NaN stays NaN.
  Folded fold(int axis, double x) const;

 private:
  std::array<FoldedAxis, max_dimension> axes_{};
};

}  // namespace gaussdrift
