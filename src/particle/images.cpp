#include "particle/images.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "gaussdrift/error.hpp"
#include "particle/subset.hpp"

namespace gaussdrift {

namespace {

constexpr double most_copies =
    8;  // of the box to each side: more cost more than a sum over the whole of space is worth

/// A copy of the box along one axis: a particle at x has its image at offset + sign x.
struct AxisCopy {
  double offset = 0, sign = 1;
};

/// Copies that have a part within reach of the box; the box itself is the first.
std::vector<AxisCopy> copies_of(const FoldedAxis& axis, int number, double reach) {
  std::vector<AxisCopy> copies{{}};
  const double length = axis.high - axis.low, sides = std::ceil(reach / length);
  if (!axis.folds()) return copies;
  if (sides > most_copies)
    throw InputError(fmt::format(
        "a blob reaches {:.3g} along {}, which is more than {:g} times the length {:.3g} of the domain there: too many "
        "images beyond its edges count. Raise particles.per_axis, or end the run before the blobs are so wide.",
        reach, "xyz"[number], most_copies, length));
  const auto add = [&](double offset, double sign) {
    const double one = offset + sign * axis.low, other = offset + sign * axis.high;
    if (std::fmax(one, other) >= axis.low - reach && std::fmin(one, other) <= axis.high + reach)
      copies.push_back({offset, sign});
  };
  const int most = static_cast<int>(sides) + 1;
  for (int m = -most; m <= most; ++m) {
    if (axis.periodic && m != 0) add(m * length, 1);
    if (!axis.mirror_low || !axis.mirror_high) continue;
    if (m != 0) add(2 * m * length, 1);
    add(2 * axis.low + 2 * m * length, -1);
  }
  if (axis.mirror_low && !axis.mirror_high) copies.push_back({2 * axis.low, -1});
  if (axis.mirror_high && !axis.mirror_low) copies.push_back({2 * axis.high, -1});
  return copies;
}

}  // namespace

Particles with_images(const Particles& particles, const Folding& folding, double reach, std::vector<std::size_t>* of) {
  std::vector<std::size_t> all(particles.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Particles images = subset(particles, all);
  if (of) *of = std::move(all);
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  std::array<std::vector<AxisCopy>, max_dimension> copies;
  std::size_t count = 1;
  for (std::size_t k = 0; k < max_dimension; ++k) {
    copies[k] = k < dimension ? copies_of(folding.axis(static_cast<int>(k)), static_cast<int>(k), reach)
                              : std::vector<AxisCopy>{{}};
    count *= copies[k].size();
  }
  for (std::size_t c = 1; c < count; ++c) {
    const std::array<AxisCopy, max_dimension> copy{copies[0][c % copies[0].size()],
                                                   copies[1][c / copies[0].size() % copies[1].size()],
                                                   copies[2][c / copies[0].size() / copies[1].size()]};
    for (std::size_t j = 0; j < particles.size(); ++j) {
      Vector x{};
      bool counts = true;
      for (std::size_t k = 0; k < dimension; ++k) {
        const FoldedAxis& axis = folding.axis(static_cast<int>(k));
        x[k] = copy[k].offset + copy[k].sign * particles.position[k][j];
        // Along an axis that does not fold all particles stay as they are: what they reach is found out later.
        counts = counts && (!axis.folds() || (x[k] >= axis.low - reach && x[k] <= axis.high + reach));
      }
      if (!counts) continue;
      for (std::size_t k = 0; k < dimension; ++k) images.position[k].push_back(x[k]);
      images.alpha.push_back(particles.alpha[j]);
      images.id.push_back(static_cast<std::int64_t>(c) * ids_of_copy + particles.id[j]);
      if (of) of->push_back(j);
    }
  }
  return images;
}

}  // namespace gaussdrift
