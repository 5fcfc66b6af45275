#include "field/density/sum_density.hpp"

namespace gaussdrift {

void SumDensity::add(const PointsView& x, double* values) const {
  for (const auto& part : parts_) part->add(x, values);
}

double SumDensity::cost() const {
  double sum = 0;
  for (const auto& part : parts_) sum += part->cost();
  return sum;
}

double SumDensity::fit_error() const {
  double sum = 0;
  for (const auto& part : parts_) sum += part->fit_error();
  return sum;
}

std::string SumDensity::describe() const {
  std::string text;
  for (const auto& part : parts_) text += (text.empty() ? "" : " + ") + part->describe();
  return text.empty() ? "rho_0 = 0" : text;
}

std::optional<double> SumDensity::mass() const {
  double sum = 0;
  for (const auto& part : parts_) {
    const auto mass = part->mass();
    if (!mass) return std::nullopt;
    sum += *mass;
  }
  return sum;
}

}  // namespace gaussdrift
