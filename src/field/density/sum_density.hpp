// Several initial densities, added.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field/density/density.hpp"

namespace gaussdrift {

class SumDensity : public InitialDensity {
 public:
  explicit SumDensity(std::vector<std::unique_ptr<InitialDensity>> parts) : parts_(std::move(parts)) {}
  void add(const PointsView& x, double* values) const override;
  double cost() const override;
  double fit_error() const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  std::vector<std::unique_ptr<InitialDensity>> parts_;
};

}  // namespace gaussdrift
