#include "field/samples/sampled_density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "field/density/describe.hpp"
#include "field/samples/direct_sum.hpp"

namespace gaussdrift {

namespace {

/// Nothing where the kernel is no sum of Gaussians that is good enough.
std::optional<double> mass_in(const SampleFit& fit, const Vector& low, const Vector& high) {
  try {
    const SampleIntegral found = integral_of(fit, low, high);
    constexpr double telling = 1e-3;  // as many digits as are told should mean something
    if (found.error <= telling * std::abs(found.value)) return found.value;
  } catch (const rbf::Error&) {  // it is not told, then
  }
  return std::nullopt;
}

template <int d>
class SampledDensity : public InitialDensity {
 public:
  SampledDensity(std::shared_ptr<const SampleFit> fit, Outside outside, const Vector& domain_low,
                 const Vector& domain_high)
      : fit_(std::move(fit)),
        box_(*fit_, outside),
        sum_(direct_sum<d>(*fit_, 0)),
        domain_low_(domain_low),
        domain_high_(domain_high) {}

  void add(const PointsView& x, double* values) const override {
    const SampleBox::Placed placed = box_.place(x);
    for (const std::size_t i : placed.lost) values[i] = std::numeric_limits<double>::quiet_NaN();
    if (placed.index.empty()) return;
    const Eigen::MatrixXd found = sum_.evaluate(points_of<d>(placed));
    for (std::size_t i = 0; i < placed.index.size(); ++i)
      values[placed.index[i]] += found(static_cast<Eigen::Index>(i), 0);
  }
  double cost() const override { return cost_of_pairs(*fit_); }
  double fit_error() const override { return fit_->largest_error; }
  std::optional<double> mass() const override {
    return box_.outside() == Outside::zero ? mass_in(*fit_, fit_->low, fit_->high) : std::nullopt;
  }
  std::string describe() const override {
    std::string text = "rho_0 = " + gaussdrift::describe(*fit_);
    bool covered = true;
    for (std::size_t k = 0; k < d; ++k)
      covered = covered && fit_->low[k] <= domain_low_[k] && domain_high_[k] <= fit_->high[k];
    if (box_.outside() != Outside::clamp || covered)
      if (const auto in_domain = mass_in(*fit_, domain_low_, domain_high_))
        text += fmt::format(", mass {:.9g} in the domain", *in_domain);
    return text;
  }

 private:
  std::shared_ptr<const SampleFit> fit_;
  SampleBox box_;
  rbf::Evaluator<d> sum_;
  Vector domain_low_, domain_high_;
};

}  // namespace

std::unique_ptr<InitialDensity> make_sampled_density(std::shared_ptr<const SampleFit> fit, Outside outside,
                                                     const Vector& domain_low, const Vector& domain_high) {
  if (fit->dimension == 2) return std::make_unique<SampledDensity<2>>(std::move(fit), outside, domain_low, domain_high);
  return std::make_unique<SampledDensity<3>>(std::move(fit), outside, domain_low, domain_high);
}

}  // namespace gaussdrift
