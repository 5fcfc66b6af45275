// Fields on the clock of a case. A run counts from 0 and goes forwards; the clock may begin at any time and go backwards.
// What lies here asks a field at the time of the clock, and turns round what flows or grows where the clock does.
// docs/decisions/0041-runs-count-from-their-start.md.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// What the clock shows when the run begins, and its direction.
struct Clock {
  double start = 0;
  bool backwards = false;

  double at(double elapsed) const { return backwards ? start - elapsed : start + elapsed; }
  double elapsed(double t) const { return backwards ? start - t : t - start; }
  bool is_plain() const { return start == 0 && !backwards; }
};

/// The flow in elapsed time: dx/ds = u(x, start + s), or -u(x, start - s). So steps and paths go forwards whatever the
/// clock does.
class ClockedVelocity : public VelocityField {
 public:
  ClockedVelocity(std::unique_ptr<VelocityField> field, const Clock& clock) : field_(std::move(field)), clock_(clock) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override { return field_->is_steady(); }
  bool is_smooth() const override { return field_->is_smooth(); }
  bool is_solenoidal() const override { return field_->is_solenoidal(); }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    return field_->flow(clock_.at(from), clock_.at(to), x);
  }
  bool evaluates_in_blocks() const override { return field_->evaluates_in_blocks(); }
  double held_until(double t) const override {
    return clock_.elapsed(clock_.backwards ? field_->held_since(clock_.at(t)) : field_->held_until(clock_.at(t)));
  }
  double held_since(double t) const override {
    return clock_.elapsed(clock_.backwards ? field_->held_until(clock_.at(t)) : field_->held_since(clock_.at(t)));
  }
  double cost() const override { return field_->cost(); }
  bool is_fitted() const override { return field_->is_fitted(); }
  double fit_error(const PointsView& near) const override { return field_->fit_error(near); }
  double shown_time(double t) const override { return clock_.at(t); }
  const VelocityField& shown() const override { return *field_; }
  std::string why_not_finite(double t, const Vector& x) const override {
    return field_->why_not_finite(clock_.at(t), x);
  }
  std::string describe() const override { return field_->describe(); }

 private:
  std::unique_ptr<VelocityField> field_;
  Clock clock_;
};

/// A rate in elapsed time: f(x, start + s), or -f(x, start - s).
class ClockedRate : public ScalarField {
 public:
  ClockedRate(std::unique_ptr<ScalarField> field, const Clock& clock) : field_(std::move(field)), clock_(clock) {}
  void add(double t, const PointsView& x, double* values) const override;
  bool is_steady() const override { return field_->is_steady(); }
  bool is_smooth() const override { return field_->is_smooth(); }
  double cost() const override { return field_->cost(); }
  std::string describe() const override { return field_->describe(); }

 private:
  std::unique_ptr<ScalarField> field_;
  Clock clock_;
};

}  // namespace gaussdrift
