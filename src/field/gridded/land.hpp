// Points of a grid without values: land, where there is no fluid. Next to it a velocity is formed from the points that
// have values. docs/method.md, section 14.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "field/gridded/grid_data.hpp"
#include "field/gridded/gridded.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// A point that has no value at one of the two times around a moment is land then.
class Land {
 public:
  Land(std::shared_ptr<const GridData> data, Outside outside) : data_(std::move(data)), outside_(outside) {}

  /// What the corners of a cell say of a place in it, with the weights of linear interpolation.
  struct Shore {
    double water = 1;  // the part of the weights that is at points with values; a place with less than half is land
    Vector slope{};    // of that part
    Vector sum{};      // of weight times value, over those points: its first components
    std::array<Vector, max_dimension> sum_slope{};  // [component]
  };
  /// Beyond the grid there is no land, unless its values go on there (Outside::clamp).
  Shore shore(double t, const Vector& x, std::size_t components) const;
  bool is_land(double t, const Vector& x) const { return shore(t, x, 0).water < least_water; }

  static constexpr double least_water = 0.5;

  /// The smallest distance of neighbours along an axis.
  double spacing(int axis) const;
  const GridData& data() const { return *data_; }

 private:
  std::shared_ptr<const GridData> data_;
  Outside outside_;
};

/// A velocity on a grid with land. Where a cell has points with and without values, it is the mean of those with values,
/// weighted as in linear interpolation. On land it goes on in the same way as far as there are such points, and then it
/// is 0, so that steps may look there; or it is not a number, so that a particle that comes there is noticed.
class CoastalVelocity : public VelocityField {
 public:
  CoastalVelocity(GridInterpolator grid, Outside outside, bool goes_on)
      : land_(grid.shared_data(), outside), velocity_(std::move(grid)), goes_on_(goes_on) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override { return velocity_.is_steady(); }
  bool is_smooth() const override { return false; }
  double cost() const override { return velocity_.cost(); }
  std::string why_not_finite(double t, const Vector& x) const override;
  std::string describe() const override { return velocity_.describe(); }

 private:
  // Empty: there is no value, and none is made up.
  std::optional<Land::Shore> near_land(double t, const Vector& x) const;
  Vector slopes(const Land::Shore& shore, int component) const;

  Land land_;
  GriddedVelocity velocity_;
  bool goes_on_;
};

}  // namespace gaussdrift
