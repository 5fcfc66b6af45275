// Fields from data on a grid: a velocity, a density, a number of place and time.
#pragma once

#include <utility>

#include "field/density/density.hpp"
#include "field/gridded/grid_data.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// u = the first components of the data. Its divergence is that of the interpolating function. To the divergence of the
/// flow behind the data it converges with one order less than the interpolation.
class GriddedVelocity : public VelocityField {
 public:
  explicit GriddedVelocity(GridInterpolator grid) : grid_(std::move(grid)) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override {
    grid_.add(t, x, static_cast<std::size_t>(x.dimension), u.axis.data());
  }
  void add_divergence(double t, const PointsView& x, double* values) const override {
    grid_.add_divergence(t, x, values);
  }
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override {
    grid_.add_gradient(t, x, gradients.slope);
  }
  bool is_steady() const override { return grid_.is_steady(); }
  double held_until(double t) const override { return grid_.held_until(t); }
  double held_since(double t) const override { return grid_.held_since(t); }
  bool is_smooth() const override { return false; }
  double cost() const override { return 10 * grid_.cost_of_place(); }
  std::string why_not_finite(double t, const Vector& x) const override {
    std::string reason = grid_.why_lost(x);
    return reason.empty() ? grid_.why_missing(t, x) : reason;
  }
  std::string describe() const override { return "u = " + grid_.describe(); }

 private:
  GridInterpolator grid_;
};

class GriddedDensity : public InitialDensity {
 public:
  /// That of the data at one time.
  explicit GriddedDensity(GridInterpolator grid, double time = 0) : grid_(std::move(grid)), time_(time) {}
  void add(const PointsView& x, double* values) const override { grid_.add(time_, x, 1, &values); }
  double cost() const override { return grid_.cost_of_place(); }
  std::string describe() const override { return "rho_0 = " + grid_.describe(); }

 private:
  GridInterpolator grid_;
  double time_;
};

class GriddedScalar : public ScalarField {
 public:
  explicit GriddedScalar(GridInterpolator grid) : grid_(std::move(grid)) {}
  void add(double t, const PointsView& x, double* values) const override { grid_.add(t, x, 1, &values); }
  bool is_steady() const override { return grid_.is_steady(); }
  bool is_smooth() const override { return false; }
  double cost() const override { return 5 * grid_.cost_of_place(); }
  std::string describe() const override { return grid_.describe(); }

 private:
  GridInterpolator grid_;
};

}  // namespace gaussdrift
