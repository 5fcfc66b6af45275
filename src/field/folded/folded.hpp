// Fields in a folded box (base/folding.hpp): what holds in the box holds in all of its copies, and vectors are mirrored
// where the copy is. So particles and paths move smoothly through all of space, as if there were no faces.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "base/folding.hpp"
#include "field/density/density.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// u(x) = S u(fold(x)), S = diag(signs of the copy). The formula of the field is asked in the box alone.
class FoldedVelocity : public VelocityField {
 public:
  /// smooth: the field goes on smoothly beyond the faces that fold.
  FoldedVelocity(std::unique_ptr<VelocityField> field, const Folding& folding, bool smooth)
      : field_(std::move(field)), folding_(folding), smooth_(smooth) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override { return field_->is_steady(); }
  bool is_smooth() const override { return smooth_ && field_->is_smooth(); }
  bool is_solenoidal() const override { return smooth_ && field_->is_solenoidal(); }
  bool evaluates_in_blocks() const override { return field_->evaluates_in_blocks(); }
  double held_until(double t) const override { return field_->held_until(t); }
  double held_since(double t) const override { return field_->held_since(t); }
  double cost() const override { return field_->cost(); }
  bool is_fitted() const override { return field_->is_fitted(); }
  double fit_error(const PointsView& near) const override;
  std::string why_not_finite(double t, const Vector& x) const override;
  std::string describe() const override { return field_->describe(); }

 private:
  std::unique_ptr<VelocityField> field_;
  Folding folding_;
  bool smooth_;
};

/// rho_0(fold(x)).
class FoldedDensity : public InitialDensity {
 public:
  FoldedDensity(std::unique_ptr<InitialDensity> density, const Folding& folding)
      : density_(std::move(density)), folding_(folding) {}
  void add(const PointsView& x, double* values) const override;
  double cost() const override { return density_->cost(); }
  double fit_error() const override { return density_->fit_error(); }
  std::string describe() const override { return density_->describe(); }
  std::optional<double> mass() const override { return density_->mass(); }

 private:
  std::unique_ptr<InitialDensity> density_;
  Folding folding_;
};

/// f(fold(x), t).
class FoldedScalar : public ScalarField {
 public:
  FoldedScalar(std::unique_ptr<ScalarField> field, const Folding& folding)
      : field_(std::move(field)), folding_(folding) {}
  void add(double t, const PointsView& x, double* values) const override;
  bool is_steady() const override { return field_->is_steady(); }
  bool is_smooth() const override { return field_->is_smooth(); }
  double cost() const override { return field_->cost(); }
  std::string describe() const override { return field_->describe(); }

 private:
  std::unique_ptr<ScalarField> field_;
  Folding folding_;
};

}  // namespace gaussdrift
