#include "field/fit_errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaussdrift {

namespace {

constexpr std::size_t most_looked_at = 256, nearest = 8;

}  // namespace

FitErrors::FitErrors(int dimension, const std::vector<double>& positions, const std::vector<double>& errors)
    : dimension_(dimension) {
  const auto d = static_cast<std::ptrdiff_t>(dimension);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    errors_.push_back(errors[i]);
    const auto from = positions.begin() + static_cast<std::ptrdiff_t>(i) * d;
    positions_.insert(positions_.end(), from, from + d);
  }
}

double FitErrors::near(const PointsView& points) const {
  const std::size_t d = static_cast<std::size_t>(dimension_), looked_at = std::min(points.count, most_looked_at);
  if (!known() || looked_at == 0) return 0;
  const std::size_t around = std::min(nearest, errors_.size());
  double sum = 0;
  std::vector<std::pair<double, std::size_t>> apart(errors_.size());
  for (std::size_t n = 0; n < looked_at; ++n) {
    const Vector at = points.at(n * points.count / looked_at);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      apart[i] = {0, i};
      for (std::size_t k = 0; k < d; ++k) {
        const double along = positions_[i * d + k] - at[k];
        apart[i].first += along * along;
      }
    }
    std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(around - 1), apart.end());
    for (std::size_t i = 0; i < around; ++i) sum += errors_[apart[i].second] * errors_[apart[i].second];
  }
  return std::sqrt(sum / static_cast<double>(looked_at * around));
}

}  // namespace gaussdrift
