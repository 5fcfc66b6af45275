#include "reference/formula.hpp"

#include <utility>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/nan.hpp"
#include "base/seam.hpp"
#include "expression/expression.hpp"
#include "reference/coordinates.hpp"

namespace gaussdrift {

namespace {

using base::nan;
constexpr std::size_t points_together = 256;  // points in one call of the expression

class Formula : public Reference {
 public:
  Formula(const std::string& rho, const std::vector<std::pair<std::string, double>>& params, const Lattice& lattice,
          std::function<double(double elapsed)> clock)
      : clock_(std::move(clock)),
        expression_(rho,
                    lattice.dimension == 3 ? std::vector<std::string>{"x", "y", "z", "t"}
                                           : std::vector<std::string>{"x", "y", "t"},
                    params),
        lattice_(lattice) {}

  ReferenceReport evaluate(double time, std::vector<double>& rho) override {
    rho.assign(lattice_.size(), 0.0);
    return fill(time, rho, [&](std::size_t i) { return i; });
  }

  ReferenceReport evaluate_at(double time, const std::vector<std::size_t>& points,
                              std::vector<double>& rho) const override {
    rho.assign(points.size(), 0.0);
    return fill(time, rho, [&](std::size_t i) { return points[i]; });
  }

 private:
  template <class PointOf>
  ReferenceReport fill(double time, std::vector<double>& rho, const PointOf& point_of) const {
    ReferenceReport report;
    const std::vector<double> times(points_together, clock_ ? clock_(time) : time);
    std::vector<double> coordinates(static_cast<std::size_t>(lattice_.dimension) * points_together);
    std::vector<std::size_t> points(points_together);
    for (std::size_t first = 0; first < rho.size(); first += points_together) {
      base::seam();
      const std::size_t count = std::min(points_together, rho.size() - first);
      for (std::size_t i = 0; i < count; ++i) points[i] = point_of(first + i);
      fill_coordinates(lattice_, points.data(), count, coordinates.data());
      std::array<const double*, max_dimension + 1> arguments{};
      for (int k = 0; k < lattice_.dimension; ++k)
        arguments[static_cast<std::size_t>(k)] = coordinates.data() + static_cast<std::size_t>(k) * count;
      arguments[static_cast<std::size_t>(lattice_.dimension)] = times.data();
      expression_.evaluate(arguments.data(), count, rho.data() + first);
      for (std::size_t i = 0; i < count; ++i) {
        if (std::isfinite(rho[first + i])) continue;
        rho[first + i] = nan;
        if (report.untraced++ > 0) continue;
        fill_coordinates(lattice_, points[i], 1, report.first_untraced.data());
        report.trouble = "the expression is not finite";
      }
    }
    return report;
  }

  std::function<double(double elapsed)> clock_;
  Expression expression_;
  Lattice lattice_;
};

}  // namespace

std::unique_ptr<Reference> formula(const std::string& rho, const std::vector<std::pair<std::string, double>>& params,
                                   const Lattice& lattice, std::function<double(double elapsed)> clock) {
  return std::make_unique<Formula>(rho, params, lattice, std::move(clock));
}

}  // namespace gaussdrift
