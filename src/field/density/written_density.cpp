#include "field/density/written_density.hpp"

#include <algorithm>
#include <array>

namespace gaussdrift {

WrittenDensity::WrittenDensity(const std::string& text, int dimension,
                               const std::vector<std::pair<std::string, double>>& params)
    : expression_(text, dimension == 3 ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"},
                  params) {}

void WrittenDensity::add(const PointsView& x, double* values) const {
  constexpr std::size_t block_length = 512;
  std::array<double, block_length> part;
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    expression_.evaluate(x.block(first, length).axis.data(), length, part.data());
    for (std::size_t i = 0; i < length; ++i) values[first + i] += part[i];
  }
}

double WrittenDensity::cost() const { return std::max(1.0, expression_.cost()); }

std::string WrittenDensity::describe() const { return "rho_0 = " + expression_.text(); }

}  // namespace gaussdrift
