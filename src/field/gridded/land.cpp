#include "field/gridded/land.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift {

namespace {

/// The two points around a place on one axis, and the weight of the second one.
struct Between {
  std::size_t first = 0;
  double second_weight = 0, slope = 0;  // the slope of that weight
};

Between between(const std::vector<double>& axis, double x) {
  const double inside = std::clamp(x, axis.front(), axis.back());
  auto cell = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), inside) - axis.begin());
  cell = std::clamp<std::size_t>(cell, 1, axis.size() - 1) - 1;
  const double h = axis[cell + 1] - axis[cell];
  return {cell, (inside - axis[cell]) / h, inside == x ? 1 / h : 0};
}

}  // namespace

Land::Shore Land::shore(double t, const Vector& x, std::size_t components) const {
  const GridData& data = *data_;
  Shore shore;
  std::array<Between, max_dimension> at;
  for (int k = 0; k < data.dimension; ++k) {
    const auto& axis = data.axis[k];
    const double rounding = std::max(1e-12 * (axis.back() - axis.front()), data.rounding[k]);
    const bool inside = x[k] >= axis.front() - rounding && x[k] <= axis.back() + rounding;
    if (std::isnan(x[k]) || (!inside && outside_ != Outside::clamp)) return shore;
    at[k] = between(axis, x[k]);
  }
  Between now;
  if (data.times.size() > 1) now = between(data.times, t);
  const std::size_t later = now.second_weight > 0 ? now.first + 1 : now.first;
  const std::vector<double>&first = data.values[now.first], &second = data.values[later];
  shore.water = 0;
  for (int corner = 0; corner < (1 << data.dimension); ++corner) {
    std::size_t point = 0, stride = 1;
    std::array<double, max_dimension> weight{1, 1, 1}, slope{};
    for (int k = 0; k < data.dimension; ++k) {
      const bool upper = ((corner >> k) & 1) != 0;
      point += (at[k].first + (upper ? 1 : 0)) * stride;
      stride *= data.axis[k].size();
      weight[k] = upper ? at[k].second_weight : 1 - at[k].second_weight;
      slope[k] = upper ? at[k].slope : -at[k].slope;
    }
    const double *const a = first.data() + point * data.components, *const b = second.data() + point * data.components;
    if (std::isnan(a[0]) || std::isnan(b[0])) continue;
    const double here = weight[0] * weight[1] * weight[2];
    const Vector change{slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                        weight[0] * weight[1] * slope[2]};
    shore.water += here;
    for (int l = 0; l < data.dimension; ++l) shore.slope[l] += change[l];
    for (std::size_t c = 0; c < components; ++c) {
      const double value = a[c] + now.second_weight * (b[c] - a[c]);
      shore.sum[c] += here * value;
      for (int l = 0; l < data.dimension; ++l) shore.sum_slope[c][l] += change[l] * value;
    }
  }
  return shore;
}

double Land::spacing(int axis) const {
  double least = std::numeric_limits<double>::infinity();
  const auto& x = data_->axis[axis];
  for (std::size_t i = 1; i < x.size(); ++i) least = std::min(least, x[i] - x[i - 1]);
  return least;
}

std::optional<Land::Shore> CoastalVelocity::near_land(double t, const Vector& x) const {
  if (!velocity_.why_not_finite(t, x).empty() || std::isnan(x[0] + x[1] + x[2])) return std::nullopt;
  const Land::Shore shore = land_.shore(t, x, static_cast<std::size_t>(land_.data().dimension));
  if (shore.water < Land::least_water && !goes_on_) return std::nullopt;
  return shore;
}

Vector CoastalVelocity::slopes(const Land::Shore& shore, int component) const {
  Vector slopes{};
  if (!(shore.water > 0)) return slopes;
  const double value = shore.sum[component] / shore.water;
  for (int l = 0; l < land_.data().dimension; ++l)
    slopes[l] = (shore.sum_slope[component][l] - value * shore.slope[l]) / shore.water;
  return slopes;
}

void CoastalVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  std::vector<double> columns(x.count * static_cast<std::size_t>(x.dimension), 0.0);
  VectorsView own{x.dimension, x.count, {}};
  for (int k = 0; k < x.dimension; ++k) own.axis[k] = columns.data() + static_cast<std::size_t>(k) * x.count;
  velocity_.add(t, x, own);
  for (std::size_t i = 0; i < x.count; ++i) {
    if (!std::isnan(own.axis[0][i])) continue;
    const auto shore = near_land(t, x.at(i));
    if (!shore) continue;
    for (int k = 0; k < x.dimension; ++k) own.axis[k][i] = shore->water > 0 ? shore->sum[k] / shore->water : 0;
  }
  for (int k = 0; k < x.dimension; ++k)
    for (std::size_t i = 0; i < x.count; ++i) u.axis[k][i] += own.axis[k][i];
}

void CoastalVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  std::vector<double> own(x.count, 0.0);
  velocity_.add_divergence(t, x, own.data());
  for (std::size_t i = 0; i < x.count; ++i) {
    if (std::isnan(own[i]))
      if (const auto shore = near_land(t, x.at(i))) {
        own[i] = 0;
        for (int k = 0; k < x.dimension; ++k) own[i] += slopes(*shore, k)[k];
      }
    values[i] += own[i];
  }
}

void CoastalVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const auto dimension = static_cast<std::size_t>(x.dimension);
  std::vector<double> columns(x.count * dimension * dimension, 0.0);
  GradientsView own{x.dimension, x.count, {}};
  for (std::size_t k = 0; k < dimension; ++k)
    for (std::size_t l = 0; l < dimension; ++l) own.slope[k][l] = columns.data() + (k * dimension + l) * x.count;
  velocity_.add_gradient(t, x, own);
  for (std::size_t i = 0; i < x.count; ++i) {
    if (!std::isnan(own.slope[0][0][i])) continue;
    const auto shore = near_land(t, x.at(i));
    if (!shore) continue;
    for (int k = 0; k < x.dimension; ++k) {
      const Vector of_component = slopes(*shore, k);
      for (int l = 0; l < x.dimension; ++l) own.slope[k][l][i] = of_component[l];
    }
  }
  for (std::size_t k = 0; k < dimension; ++k)
    for (std::size_t l = 0; l < dimension; ++l)
      for (std::size_t i = 0; i < x.count; ++i) gradients.slope[k][l][i] += own.slope[k][l][i];
}

std::string CoastalVelocity::why_not_finite(double t, const Vector& x) const {
  std::string reason = velocity_.why_not_finite(t, x);
  if (!reason.empty() || !land_.is_land(t, x)) return reason;
  return fmt::format(
      "it has reached land, where {} has no value: domain.coast = \"stop\", \"slide\" or \"remove\" says what happens "
      "to such particles, velocity.missing = \"zero\" or \"nearest\" puts a velocity there",
      land_.data().name);
}

}  // namespace gaussdrift
