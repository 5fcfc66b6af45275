#include "field/folded/folded.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace gaussdrift {

namespace {

/// Many points where they lie in the box.
class FoldedPoints {
 public:
  FoldedPoints(const PointsView& x, const Folding& folding) : points_(x) {
    for (int k = 0; k < x.dimension; ++k) {
      const FoldedAxis& axis = folding.axis(k);
      const double* const from = x.axis[k];
      const double low = axis.low, high = axis.high;
      if (!axis.folds() || std::all_of(from, from + x.count, [&](double at) { return at >= low && at < high; }))
        continue;  // mostly all of them are in the box
      auto& [folded, signs] = axes_[static_cast<std::size_t>(k)];
      folded.resize(x.count);
      signs.resize(x.count);
      for (std::size_t i = 0; i < x.count; ++i) {
        const Folded place = folding.fold(k, from[i]);
        folded[i] = place.x, signs[i] = place.sign;
        mirrored_ = mirrored_ || place.sign < 0;
      }
      points_.axis[k] = folded.data();
    }
  }

  const PointsView& points() const { return points_; }
  /// False: the signs of all points are 1.
  bool mirrored() const { return mirrored_; }
  double sign(int axis, std::size_t i) const {
    const auto& signs = axes_[static_cast<std::size_t>(axis)].second;
    return signs.empty() ? 1 : signs[i];
  }

 private:
  PointsView points_;
  std::array<std::pair<std::vector<double>, std::vector<double>>, max_dimension> axes_;
  bool mirrored_ = false;
};

}  // namespace

void FoldedVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  const FoldedPoints folded(x, folding_);
  if (!folded.mirrored()) return field_->add(t, folded.points(), u);
  std::vector<double> columns(x.count * static_cast<std::size_t>(x.dimension), 0.0);
  VectorsView in_box{x.dimension, x.count, {}};
  for (int k = 0; k < x.dimension; ++k) in_box.axis[k] = columns.data() + static_cast<std::size_t>(k) * x.count;
  field_->add(t, folded.points(), in_box);
  for (int k = 0; k < x.dimension; ++k)
    for (std::size_t i = 0; i < x.count; ++i) u.axis[k][i] += folded.sign(k, i) * in_box.axis[k][i];
}

void FoldedVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  field_->add_divergence(t, FoldedPoints(x, folding_).points(), values);
}

void FoldedVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const FoldedPoints folded(x, folding_);
  if (!folded.mirrored()) return field_->add_gradient(t, folded.points(), gradients);
  const auto dimension = static_cast<std::size_t>(x.dimension);
  std::vector<double> columns(x.count * dimension * dimension, 0.0);
  GradientsView in_box{x.dimension, x.count, {}};
  for (std::size_t k = 0; k < dimension; ++k)
    for (std::size_t i = 0; i < dimension; ++i) in_box.slope[k][i] = columns.data() + (k * dimension + i) * x.count;
  field_->add_gradient(t, folded.points(), in_box);
  for (int k = 0; k < x.dimension; ++k)
    for (int i = 0; i < x.dimension; ++i)
      for (std::size_t j = 0; j < x.count; ++j)
        gradients.slope[k][i][j] += folded.sign(k, j) * folded.sign(i, j) * in_box.slope[k][i][j];
}

double FoldedVelocity::fit_error(const PointsView& near) const {
  return field_->fit_error(FoldedPoints(near, folding_).points());
}

std::string FoldedVelocity::why_not_finite(double t, const Vector& x) const {
  Vector in_box = x;
  for (int k = 0; k < max_dimension; ++k) in_box[k] = folding_.fold(k, x[k]).x;
  return field_->why_not_finite(t, in_box);
}

void FoldedDensity::add(const PointsView& x, double* values) const {
  density_->add(FoldedPoints(x, folding_).points(), values);
}

void FoldedScalar::add(double t, const PointsView& x, double* values) const {
  field_->add(t, FoldedPoints(x, folding_).points(), values);
}

}  // namespace gaussdrift
