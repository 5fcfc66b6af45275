#include "sim/inflow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "field/velocity/velocity.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

std::vector<std::string> variables(int dimension) {
  return dimension == 3 ? std::vector<std::string>{"x", "y", "z", "t"} : std::vector<std::string>{"x", "y", "t"};
}

/// Cells along an axis that lies in the face.
std::size_t cells_along(const Domain& domain, int axis, double spacing) {
  const auto a = static_cast<std::size_t>(axis);
  return static_cast<std::size_t>(std::max(1.0, std::round((domain.max[a] - domain.min[a]) / spacing)));
}

// Gauss's rule of three points on [-1, 1], exact for polynomials of degree 5.
constexpr std::array<double, 3> node{-0.774596669241483377, 0, 0.774596669241483377}, weight{5. / 9, 8. / 9, 5. / 9};

}  // namespace

Inflow::Inflow(const Case& spec, const FaceSourceSpec& source, const Scene& scene, double from, double to)
    : scene_(scene),
      clock_(spec.time),
      domain_(spec.domain),
      face_{source.axis, source.upper},
      concentration_(source.concentration, variables(spec.domain.dimension), spec.params),
      spacing_(scene.seeding.spacing) {
  constexpr int times = 17;
  const Points middles = points(1);
  const bool steady = scene.velocity->is_steady();
  for (int i = 0; i < (steady ? 1 : times); ++i)
    for (const double speed : inwards(from + (to - from) * i / (times - 1), middles.places.view()))
      fastest_ = std::max(fastest_, speed);
  if (!(fastest_ > 0))
    throw InputError(
        fmt::format("nothing can come in through {}: the velocity does not lead into the domain there at any time "
                    "that was looked at from t = {:.6g} to {:.6g}",
                    face_.name(), clock_.at(from), clock_.at(to)));
}

std::size_t Inflow::cells_of(const Case& spec, const FaceSourceSpec& source) {
  const double spacing = seeding_lattice(spec.domain, spec.particles.per_axis).spacing;
  std::size_t cells = 1;
  for (int k = 0; k < spec.domain.dimension; ++k)
    if (k != source.axis) cells *= cells_along(spec.domain, k, spacing);
  return cells;
}

// `along` points on each axis of a cell: its middle, or those of Gauss's rule.
Inflow::Points Inflow::points(int along) const {
  Points all;
  all.places.dimension = domain_.dimension;
  std::vector<std::array<double, max_dimension>> corners{{}};  // of cells, in the face
  std::array<double, max_dimension> width{};
  for (int k = 0; k < domain_.dimension; ++k) {
    const auto a = static_cast<std::size_t>(k);
    if (k == face_.axis) continue;
    const std::size_t cells = cells_along(domain_, k, spacing_);
    width[a] = (domain_.max[a] - domain_.min[a]) / static_cast<double>(cells);
    std::vector<std::array<double, max_dimension>> more;
    for (const auto& corner : corners)
      for (std::size_t i = 0; i < cells; ++i) {
        more.push_back(corner);
        more.back()[a] = domain_.min[a] + width[a] * static_cast<double>(i);
      }
    corners = std::move(more);
    all.of_cell *= static_cast<std::size_t>(along);
  }
  for (const auto& corner : corners)
    for (std::size_t point = 0; point < all.of_cell; ++point) {
      std::size_t rest = point;
      double area = 1;
      for (int k = 0; k < domain_.dimension; ++k) {
        const auto a = static_cast<std::size_t>(k);
        if (k == face_.axis) {
          all.places.position[a].push_back(face_.upper ? domain_.max[a] : domain_.min[a]);
          continue;
        }
        const std::size_t i = rest % static_cast<std::size_t>(along);
        rest /= static_cast<std::size_t>(along);
        all.places.position[a].push_back(corner[a] + width[a] * (along == 1 ? 0.5 : (1 + node[i]) / 2));
        area *= width[a] * (along == 1 ? 1 : weight[i] / 2);
      }
      all.places.alpha.push_back(area);
    }
  return all;
}

Particles Inflow::places() const {
  Particles all = points(1).places;
  std::fill(all.alpha.begin(), all.alpha.end(), 1.0);
  return all;
}

// The velocity inwards where it is positive, in elapsed time. Nothing comes from land.
std::vector<double> Inflow::inwards(double t, const PointsView& x) const {
  std::vector<double> columns(x.count * static_cast<std::size_t>(x.dimension), 0.0), speeds(x.count);
  VectorsView u{x.dimension, x.count, {}};
  for (int k = 0; k < x.dimension; ++k) u.axis[k] = columns.data() + static_cast<std::size_t>(k) * x.count;
  scene_.velocity->add(t, x, u);
  for (std::size_t i = 0; i < x.count; ++i) {
    const double across = u.axis[static_cast<std::size_t>(face_.axis)][i];
    if (scene_.coast && scene_.coast->is_land(t, x.at(i))) continue;
    if (!std::isfinite(across)) {
      const std::string reason = scene_.velocity->why_not_finite(t, x.at(i));
      throw NumericalError(fmt::format("the velocity through {} is not finite at t = {:.10g}{}{}", face_.name(),
                                       clock_.at(t), reason.empty() ? "" : "; ", reason));
    }
    speeds[i] = std::max(0.0, face_.upper ? -across : across);
  }
  return speeds;
}

std::vector<double> Inflow::carried_in(double from, double to) const {
  const Points all = points(3);
  const PointsView x = all.places.view();
  std::vector<double> sums(x.count / all.of_cell, 0.0), values(x.count);
  std::array<const double*, max_dimension + 1> arguments{};
  for (int k = 0; k < x.dimension; ++k) arguments[static_cast<std::size_t>(k)] = x.axis[k];
  const double half = (to - from) / 2;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const double t = from + half + half * node[i];
    const std::vector<double> times(x.count, clock_.at(t)), speeds = inwards(t, x);
    arguments[static_cast<std::size_t>(x.dimension)] = times.data();
    concentration_.evaluate(arguments.data(), x.count, values.data());
    for (std::size_t j = 0; j < x.count; ++j) {
      if (speeds[j] == 0) continue;
      if (!std::isfinite(values[j]))
        throw NumericalError(fmt::format("the concentration \"{}\" is not finite on {} at t = {:.10g}",
                                         concentration_.text(), face_.name(), clock_.at(t)));
      sums[j / all.of_cell] += half * weight[i] * all.places.alpha[j] * speeds[j] * values[j];
    }
  }
  return sums;
}

}  // namespace gaussdrift
