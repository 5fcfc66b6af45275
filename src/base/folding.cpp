#include "base/folding.hpp"

#include <algorithm>
#include <cmath>

namespace gaussdrift {

namespace {

// x - low as a number in [0, period).
double within(double distance, double period) {
  const double rest = distance - period * std::floor(distance / period);
  return rest < period && rest >= 0 ? rest : 0;  // rounding may give the period itself
}

}  // namespace

Folded Folding::fold(int k, double x) const {
  const FoldedAxis& axis = axes_[static_cast<std::size_t>(k)];
  const double length = axis.high - axis.low;
  if (!axis.folds() || !std::isfinite(x)) return {x, 1};
  if (axis.periodic) return {x >= axis.low && x < axis.high ? x : axis.low + within(x - axis.low, length), 1};
  if (x >= axis.low && x <= axis.high) return {x, 1};
  if (axis.mirror_low && axis.mirror_high) {
    const double along = within(x - axis.low, 2 * length);
    return along <= length ? Folded{axis.low + along, 1} : Folded{std::max(axis.low, axis.high - (along - length)), -1};
  }
  // One mirror: space has two copies, and the other end has nothing to say.
  if (axis.mirror_low) return x < axis.low ? Folded{axis.low + (axis.low - x), -1} : Folded{x, 1};
  return x > axis.high ? Folded{axis.high - (x - axis.high), -1} : Folded{x, 1};
}

}  // namespace gaussdrift
