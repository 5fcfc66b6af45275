#include "field/clocked/clocked.hpp"

#include <cstddef>

namespace gaussdrift {

namespace {

void negate(double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) values[i] = -values[i];
}

/// values -= what `add` adds, without another array.
template <class Negate, class Add>
void subtract(bool backwards, const Negate& negate_all, const Add& add) {
  if (backwards) negate_all();
  add();
  if (backwards) negate_all();
}

}  // namespace

void ClockedVelocity::add(double t, const PointsView& x, const VectorsView& u) const {
  const auto negate_all = [&] {
    for (int k = 0; k < u.dimension; ++k) negate(u.axis[k], u.count);
  };
  subtract(clock_.backwards, negate_all, [&] { field_->add(clock_.at(t), x, u); });
}

void ClockedVelocity::add_divergence(double t, const PointsView& x, double* values) const {
  subtract(
      clock_.backwards, [&] { negate(values, x.count); }, [&] { field_->add_divergence(clock_.at(t), x, values); });
}

void ClockedVelocity::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const auto negate_all = [&] {
    for (int k = 0; k < gradients.dimension; ++k)
      for (int i = 0; i < gradients.dimension; ++i) negate(gradients.slope[k][i], gradients.count);
  };
  subtract(clock_.backwards, negate_all, [&] { field_->add_gradient(clock_.at(t), x, gradients); });
}

void ClockedRate::add(double t, const PointsView& x, double* values) const {
  subtract(
      clock_.backwards, [&] { negate(values, x.count); }, [&] { field_->add(clock_.at(t), x, values); });
}

}  // namespace gaussdrift
