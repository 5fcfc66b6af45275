#include "effect/nodes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gaussdrift/error.hpp"

namespace gaussdrift {

Nodes::Nodes(const Lattice& lattice, bool has_images)
    : lattice_(lattice), bits_(lattice.dimension == 3 ? (has_images ? 15 : 20) : (has_images ? 22 : 30)) {}

std::int64_t Nodes::id(const NodeIndex& index) const {
  bool inside = true;
  for (int k = 0; k < dimension(); ++k)
    inside = inside && index[k] >= 0 && index[k] < static_cast<std::int64_t>(lattice_.points[k]);
  std::int64_t number = 0;
  for (int k = dimension() - 1; k >= 0; --k) {
    if (inside) {
      number = number * static_cast<std::int64_t>(lattice_.points[k]) + index[k];
      continue;
    }
    if (index[k] < -reach() || index[k] >= reach())
      throw NumericalError(
          fmt::format("particles are {} lattice spacings away from the domain, and effects that put particles on a "
                      "lattice reach only {}. Shorten time.end, or enlarge the domain.",
                      std::abs(index[k]), reach()));
    number = (number << bits_) + (index[k] + reach());
  }
  return inside ? number : -1 - number;
}

NodeIndex Nodes::index(std::int64_t id) const {
  NodeIndex index{};
  std::int64_t number = id >= 0 ? id : -1 - id;
  for (int k = 0; k < dimension(); ++k) {
    if (id >= 0) {
      const auto points = static_cast<std::int64_t>(lattice_.points[k]);
      index[k] = number % points;
      number /= points;
    } else {
      index[k] = (number & ((std::int64_t{1} << bits_) - 1)) - reach();
      number >>= bits_;
    }
  }
  return index;
}

Vector Nodes::position(const NodeIndex& index) const {
  Vector x{};
  for (int k = 0; k < dimension(); ++k) x[k] = lattice_.origin[k] + static_cast<double>(index[k]) * lattice_.spacing;
  return x;
}

double Nodes::cell() const { return std::pow(lattice_.spacing, dimension()); }

}  // namespace gaussdrift
