// Several velocity fields, added.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// The sum of several fields. Its flow is known only if it has one part.
class SumField : public VelocityField {
 public:
  explicit SumField(std::vector<std::unique_ptr<VelocityField>> fields) : fields_(std::move(fields)) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override;
  bool is_smooth() const override;
  bool is_solenoidal() const override;
  std::optional<Vector> flow(double from, double to, const Vector& x) const override;
  bool evaluates_in_blocks() const override;
  double held_until(double t) const override;
  double held_since(double t) const override;
  double cost() const override;
  bool is_fitted() const override;
  double fit_error(const PointsView& near) const override;
  std::string why_not_finite(double t, const Vector& x) const override;
  std::string describe() const override;

 private:
  std::vector<std::unique_ptr<VelocityField>> fields_;
};

}  // namespace gaussdrift
