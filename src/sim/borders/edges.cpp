#include "sim/borders/edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/longest_side.hpp"
#include "particle/images.hpp"

namespace gaussdrift {

namespace {

/// Points of a face, evenly spread.
std::vector<Vector> points_of_face(const Domain& domain, int axis, double at) {
  constexpr int along = 33;  // in the plane; as many rows as columns in space
  std::vector<Vector> points;
  const int one = axis == 0 ? 1 : 0, other = domain.dimension == 3 ? 3 - axis - one : -1;
  const auto coordinate = [&](int k, int i) {
    const auto a = static_cast<std::size_t>(k);
    return domain.min[a] + (domain.max[a] - domain.min[a]) * (i + 0.5) / along;
  };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < (other < 0 ? 1 : along); ++j) {
      Vector x{};
      x[static_cast<std::size_t>(axis)] = at;
      x[static_cast<std::size_t>(one)] = coordinate(one, i);
      if (other >= 0) x[static_cast<std::size_t>(other)] = coordinate(other, j);
      points.push_back(x);
    }
  return points;
}

std::vector<Vector> velocities(const VelocityField& velocity, double t, const std::vector<Vector>& points,
                               int dimension) {
  std::vector<double> columns(2 * points.size() * static_cast<std::size_t>(dimension), 0.0);
  PointsView x{dimension, points.size(), {}};
  VectorsView u{dimension, points.size(), {}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    double* const places = columns.data() + 2 * k * points.size();
    for (std::size_t i = 0; i < points.size(); ++i) places[i] = points[i][k];
    x.axis[k] = places, u.axis[k] = places + points.size();
  }
  velocity.add(t, x, u);
  std::vector<Vector> found(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) found[i][k] = u.axis[k][i];
  return found;
}

/// What a velocity has too much at a face, where that is most.
struct Misfit {
  double size = 0, time = 0;
  Vector place{};
};

std::string at_place(const Misfit& misfit, int dimension) {
  std::string place;
  for (int k = 0; k < dimension; ++k)
    place += fmt::format("{}{:.4g}", k ? ", " : "", misfit.place[static_cast<std::size_t>(k)]);
  return fmt::format("({}), t = {:.4g}", place, misfit.time);
}

}  // namespace

std::vector<Face> faces_of(const Domain& domain, Edge edge) {
  std::vector<Face> faces;
  for (int k = 0; k < domain.dimension; ++k)
    for (const bool upper : {false, true})
      if (domain.edges[static_cast<std::size_t>(k)][upper] == edge) faces.push_back({k, upper});
  return faces;
}

std::string coast_words(AtCoast rule) {
  switch (rule) {
    case AtCoast::stop:
      return "particles that reach land stay there";
    case AtCoast::slide:
      return "particles that reach land move along it";
    case AtCoast::remove:
      return "particles that reach land leave the run and are counted";
    case AtCoast::refuse:
      break;
  }
  return "a particle that reaches land ends the run";
}

std::string edges_text(const Domain& domain) {
  constexpr std::array<const char*, 4> words{"unbounded", "periodic", "open", "closed"};  // in the order of Edge
  const auto word = [&](Edge edge) { return words[static_cast<std::size_t>(edge)]; };
  std::string text;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
    const auto& [low, high] = domain.edges[k];
    text += fmt::format("{}{} {}{}", k ? ", " : "", "xyz"[k], word(low),
                        low == high ? "" : fmt::format(" and {}", word(high)));
  }
  return text;
}

Folding folding_of(const Domain& domain) {
  std::array<FoldedAxis, max_dimension> axes{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k)
    axes[k] = {.periodic = domain.edges[k][0] == Edge::periodic,
               .mirror_low = domain.edges[k][0] == Edge::closed,
               .mirror_high = domain.edges[k][1] == Edge::closed,
               .low = domain.min[k],
               .high = domain.max[k]};
  // Around the sphere a place is met again, whatever part of it the domain is.
  if (domain.on_sphere()) {
    const double beside = (360 - (domain.max[0] - domain.min[0])) / 2;
    axes[0] = {.periodic = true, .low = domain.min[0] - beside, .high = domain.max[0] + beside};
  }
  return Folding(axes);
}

Folding folding_of_blobs(const Domain& domain) { return domain.on_sphere() ? Folding() : folding_of(domain); }

namespace {

/// Along this axis particles and images of them are one lattice.
bool lattice_folds(const Domain& domain, const FoldedAxis& axis, int k) {
  return axis.folds() && domain.edges[static_cast<std::size_t>(k)] != std::array<Edge, 2>{} &&
         domain.edges[static_cast<std::size_t>(k)] != std::array{Edge::open, Edge::open};
}

}  // namespace

double rounding_of(const Domain& domain) { return 1e-9 * longest_side(domain.dimension, domain.min, domain.max); }

Lattice seeding_lattice(const Domain& domain, int per_axis) {
  Lattice lattice = make_lattice(domain.dimension, domain.min, domain.max, per_axis);
  const Folding folding = folding_of(domain);
  for (int k = 0; k < domain.dimension; ++k) {
    const FoldedAxis& axis = folding.axis(k);
    if (!lattice_folds(domain, axis, k)) continue;
    const auto a = static_cast<std::size_t>(k);
    const double cells = std::max(1.0, std::round((axis.high - axis.low) / lattice.spacing));
    lattice.points[a] = static_cast<std::size_t>(cells);
    lattice.origin[a] = axis.low + (axis.periodic ? 0 : lattice.spacing / 2);
  }
  lattice.sphere = domain.sphere;
  return lattice;
}

std::optional<int> axis_without_whole_cells(const Domain& domain, int per_axis) {
  const Lattice lattice = make_lattice(domain.dimension, domain.min, domain.max, per_axis);
  const Folding folding = folding_of(domain);
  for (int k = 0; k < domain.dimension; ++k) {
    const FoldedAxis& axis = folding.axis(k);
    const double cells = (axis.high - axis.low) / lattice.spacing;
    if (lattice_folds(domain, axis, k) && (std::round(cells) < 1 || std::abs(cells - std::round(cells)) > 1e-9 * cells))
      return k;
  }
  return std::nullopt;
}

std::vector<int> per_axis_with_whole_cells(const Domain& domain, int per_axis, std::size_t most) {
  std::vector<int> good;
  for (int away = 0; away < per_axis && good.size() < most; ++away)
    for (const int other : {per_axis + away, per_axis - away})
      if (other >= 2 && (away > 0 || good.empty()) && !axis_without_whole_cells(domain, other)) good.push_back(other);
  return good;
}

std::vector<std::string> misfits_at_faces(const VelocityField& velocity, const Domain& domain, const TimeSpec& time) {
  std::vector<std::string> words;
  constexpr int times = 5;
  constexpr double rounding = 1e-9;  // of the largest velocity at the faces
  const Folding folding = folding_of(domain);
  for (int k = 0; k < domain.dimension; ++k) {
    const FoldedAxis& axis = folding.axis(k);
    const auto a = static_cast<std::size_t>(k);
    Misfit jump, through;
    double largest = 0;
    for (int i = 0; lattice_folds(domain, axis, k) && i < (velocity.is_steady() ? 1 : times); ++i) {
      const double t = time.at(time.end * i / (times - 1));
      const std::vector<Vector> low = points_of_face(domain, k, axis.low), high = points_of_face(domain, k, axis.high);
      const auto below = velocities(velocity, t, low, domain.dimension),
                 above = velocities(velocity, t, high, domain.dimension);
      const auto raise = [&](Misfit& misfit, double size, const Vector& place) {
        if (size > misfit.size) misfit = {size, t, place};  // not what is not finite: the steps report that
      };
      for (std::size_t p = 0; p < low.size(); ++p) {
        for (std::size_t c = 0; c < static_cast<std::size_t>(domain.dimension); ++c) {
          for (const double u : {below[p][c], above[p][c]})
            if (std::isfinite(u)) largest = std::max(largest, std::abs(u));
          if (axis.periodic) raise(jump, std::abs(above[p][c] - below[p][c]), high[p]);
        }
        if (axis.mirror_low) raise(through, std::abs(below[p][a]), low[p]);
        if (axis.mirror_high) raise(through, std::abs(above[p][a]), high[p]);
      }
    }
    if (jump.size > rounding * largest)
      words.push_back(
          fmt::format("the velocity is not periodic along {}: at {} it differs by {:.3g} from that at the other end. "
                      "Particles that cross this edge are misplaced by up to that times time.step",
                      "xyz"[k], at_place(jump, domain.dimension), jump.size));
    if (through.size > rounding * largest)
      words.push_back(fmt::format(
          "the velocity goes through a closed edge: at {} its component along {} is {:.3g} there. Particles "
          "gather at the edge or leave it, and the exact density does not contain what gathers",
          at_place(through, domain.dimension), "xyz"[k], through.size));
  }
  return words;
}

Domain domain_of_sum(const Case& spec, double elapsed) {
  Domain domain = spec.domain;
  for (const SourceSpec& source : spec.sources) {
    const auto* face = std::get_if<FaceSourceSpec>(&source.what);
    const double length = 1e-9 * std::max(1.0, spec.time.end);  // times that are the same but for rounding
    if (!face || source.at || elapsed < source.from - length || elapsed > source.to + length) continue;
    Edge& edge = domain.edges[static_cast<std::size_t>(face->axis)][face->upper ? 1 : 0];
    if (edge == Edge::open) edge = Edge::closed;
  }
  return domain;
}

const Particles& summed_particles(const Domain& domain, const Particles& particles, double reach, Particles& images) {
  const Folding folding = folding_of_blobs(domain);
  if (!folding.folds()) return particles;
  images = with_images(particles, folding, reach);
  return images;
}

void fold_positions(const Folding& folding, Particles& particles) {
  for (int k = 0; k < particles.dimension; ++k)
    if (folding.axis(k).folds())
      for (double& x : particles.position[static_cast<std::size_t>(k)]) x = folding.fold(k, x).x;
}

}  // namespace gaussdrift
