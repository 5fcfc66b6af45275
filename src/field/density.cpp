#include "field/density.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gaussdrift {

namespace {

double profile_value(RadialDensity::Profile profile, double s) {
  using Profile = RadialDensity::Profile;
  switch (profile) {
    case Profile::wendland: {
      const double outside = std::max(0.0, 1 - s), square = outside * outside;
      return square * square * (4 * s + 1);
    }
    case Profile::cone:
      return std::max(0.0, 1 - s);
    case Profile::gaussian:
      return std::exp(-s * s);
    case Profile::disk:
      return s < 1 ? 1 : 0;
  }
  return 0;
}

}  // namespace

void RadialDensity::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    double square = 0;
    for (int k = 0; k < x.dimension; ++k) {
      const double distance = (x.axis[k][i] - center_[k]) / radius_;
      square += distance * distance;
    }
    values[i] += height_ * profile_value(profile_, std::sqrt(square));
  }
}

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

}  // namespace gaussdrift
