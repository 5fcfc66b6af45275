// The flow at a block of points, as columns.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "field/velocity/velocity.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift {

class FlowOnBlock {
 public:
  FlowOnBlock(int dimension, std::size_t most, bool with_gradient)
      : dimension_(dimension), with_gradient_(with_gradient) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
      place_[k].resize(most), velocity_[k].resize(most);
      for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) gradient_[k][i].resize(most);
    }
  }

  /// coordinate(k, j): of point j on axis k.
  template <class Coordinate>
  void evaluate(const VelocityField& velocity, double t, std::size_t count, const Coordinate& coordinate) {
    PointsView points{dimension_, count, {}};
    VectorsView u{dimension_, count, {}};
    GradientsView slopes{dimension_, count, {}};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
      for (std::size_t j = 0; j < count; ++j) place_[k][j] = coordinate(k, j);
      points.axis[k] = place_[k].data();
      std::fill_n(velocity_[k].begin(), count, 0.0);
      u.axis[k] = velocity_[k].data();
      for (std::size_t i = 0; i < static_cast<std::size_t>(dimension_); ++i) {
        std::fill_n(gradient_[k][i].begin(), count, 0.0);
        slopes.slope[k][i] = gradient_[k][i].data();
      }
    }
    velocity.add(t, points, u);
    if (with_gradient_) velocity.add_gradient(t, points, slopes);
  }

  FlowThere at(std::size_t j) const {
    FlowThere flow;
    flow.dimension = dimension_;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
      flow.velocity[k] = velocity_[k][j];
      for (std::size_t i = 0; i < static_cast<std::size_t>(dimension_); ++i) flow.gradient[k][i] = gradient_[k][i][j];
    }
    return flow;
  }

 private:
  using Column = std::vector<double>;
  int dimension_;
  bool with_gradient_;
  std::array<Column, max_dimension> place_, velocity_;
  std::array<std::array<Column, max_dimension>, max_dimension> gradient_;
};

}  // namespace gaussdrift
