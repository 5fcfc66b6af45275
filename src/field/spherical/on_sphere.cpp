#include "field/spherical/on_sphere.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/sphere.hpp"

namespace gaussdrift {

namespace {

constexpr double a_degree = radians(1);

/// Velocity and gradient of a field in the plane of the coordinates, at some points.
class FlowAt {
 public:
  FlowAt(const VelocityField& field, double t, const PointsView& x, bool with_gradient) : x_(x) {
    const std::size_t count = x.count;
    values_.assign((with_gradient ? 6 : 2) * count, 0.0);
    const VectorsView u{2, count, {values_.data(), values_.data() + count}};
    field.add(t, x, u);
    if (!with_gradient) return;
    GradientsView slopes{2, count, {}};
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < 2; ++i) slopes.slope[k][i] = values_.data() + (2 + 2 * k + i) * count;
    field.add_gradient(t, x, slopes);
  }

  double u(std::size_t k, std::size_t j) const { return values_[k * x_.count + j]; }
  double slope(std::size_t k, std::size_t i, std::size_t j) const { return values_[(2 + 2 * k + i) * x_.count + j]; }
  double latitude(std::size_t j) const { return radians(x_.axis[1][j]); }

 private:
  PointsView x_;
  std::vector<double> values_;  // u, v, u_x, u_y, v_x, v_y
};

bool is_at_pole(double latitude) { return !(std::abs(latitude) <= 90 - nearest_to_pole); }

}  // namespace

DegreesVelocity::DegreesVelocity(std::unique_ptr<VelocityField> field, Of kind, double radius)
    : VelocityOfOther(*field), field_(std::move(field)), kind_(kind), degrees_(1 / (a_degree * radius)) {}

void DegreesVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  const FlowAt flow(*field_, t, x, false);
  const double k = degrees_;
  for (std::size_t j = 0; j < x.count; ++j) {
    const double secant = 1 / std::cos(flow.latitude(j));
    u.axis[0][j] += (kind_ == Of::components ? k : k * k) * secant * flow.u(0, j);
    u.axis[1][j] += (kind_ == Of::components ? k : k * k * secant) * flow.u(1, j);
  }
}

void DegreesVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  const FlowAt flow(*field_, t, x, kind_ == Of::components);
  const double k = degrees_;
  for (std::size_t j = 0; j < x.count; ++j) {
    const double y = flow.latitude(j), secant = 1 / std::cos(y);
    values[j] += kind_ == Of::components ? k * (secant * flow.slope(0, 0, j) + flow.slope(1, 1, j))
                                         : k * k * secant * std::tan(y) * a_degree * flow.u(1, j);
  }
}

// d(1/cos y)/dy = tan y / cos y.
void DegreesVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const FlowAt flow(*field_, t, x, true);
  const double k = degrees_;
  for (std::size_t j = 0; j < x.count; ++j) {
    const double y = flow.latitude(j), secant = 1 / std::cos(y), tangent = std::tan(y) * a_degree;
    const std::array<double, 2> factor{(kind_ == Of::components ? k : k * k) * secant,
                                       kind_ == Of::components ? k : k * k * secant};
    const std::array<double, 2> along{tangent, kind_ == Of::components ? 0 : tangent};  // d log factor / dy
    for (std::size_t c = 0; c < 2; ++c) {
      gradients.slope[c][0][j] += factor[c] * flow.slope(c, 0, j);
      gradients.slope[c][1][j] += factor[c] * (flow.slope(c, 1, j) + along[c] * flow.u(c, j));
    }
  }
}

void LengthsVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  const FlowAt flow(other(), t, x, false);
  for (std::size_t j = 0; j < x.count; ++j) {
    u.axis[0][j] += radius_ * a_degree * std::cos(flow.latitude(j)) * flow.u(0, j);
    u.axis[1][j] += radius_ * a_degree * flow.u(1, j);
  }
}

void LengthsVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  const FlowAt flow(other(), t, x, true);
  for (std::size_t j = 0; j < x.count; ++j)
    values[j] += flow.slope(0, 0, j) + flow.slope(1, 1, j) - a_degree * std::tan(flow.latitude(j)) * flow.u(1, j);
}

// Of u = R cos y dx/dt and v = R dy/dt, with the turning of the directions east and north:
//   du/de = u_x / (R cos y) - v tan y / R,  dv/de = v_x / (R cos y) + u tan y / R,  du/dn = u_y / R,  dv/dn = v_y / R.
void LengthsVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const FlowAt flow(other(), t, x, true);
  for (std::size_t j = 0; j < x.count; ++j) {
    const double y = flow.latitude(j), c = std::cos(y), turned = std::sin(y) * a_degree * flow.u(0, j);
    gradients.slope[0][0][j] += flow.slope(0, 0, j) - std::tan(y) * a_degree * flow.u(1, j);
    gradients.slope[0][1][j] += c * flow.slope(0, 1, j) - turned;
    gradients.slope[1][0][j] += flow.slope(1, 0, j) / c + turned;
    gradients.slope[1][1][j] += flow.slope(1, 1, j);
  }
}

SphereVelocity::SphereVelocity(std::unique_ptr<VelocityField> field, double radius, bool solenoidal)
    : VelocityOfOther(*field),
      field_(std::move(field)),
      solenoidal_(solenoidal),
      lengths_(*field_, radius),
      shown_(field_->shown(), radius) {}

void SphereVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  field_->add(t, x, u);
  for (std::size_t j = 0; j < x.count; ++j)
    if (is_at_pole(x.axis[1][j])) u.axis[0][j] = u.axis[1][j] = std::numeric_limits<double>::quiet_NaN();
}

void SphereVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  if (solenoidal_) return;
  const FlowAt flow(*field_, t, x, false);
  field_->add_divergence(t, x, values);
  for (std::size_t j = 0; j < x.count; ++j) values[j] -= a_degree * std::tan(flow.latitude(j)) * flow.u(1, j);
}

void SphereVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  field_->add_gradient(t, x, gradients);
}

std::string SphereVelocity::why_not_finite(double t, const Vector& x) const {
  if (!is_at_pole(x[1])) return field_->why_not_finite(t, x);
  return fmt::format(
      "it has come to the latitude {:.6g}, and within {:g} degrees of a pole longitudes are of no use: shorten "
      "time.end, move the density, or let domain.edges be open at a latitude before the pole",
      x[1], nearest_to_pole);
}

}  // namespace gaussdrift
