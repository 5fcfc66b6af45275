#include "particle/seeding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

// One line of lattice points along the first axis, other indices fixed.
struct Line {
  std::size_t first = 0;  // number of its first point
  std::array<std::vector<double>, max_dimension> x;
  std::vector<std::vector<double>> weights;  // one array for each of the things carried

  std::size_t size() const { return x[0].size(); }
};

std::string place_text(const Line& line, std::size_t i, int dimension) {
  std::string text = fmt::format("({}, {}", line.x[0][i], line.x[1][i]);
  return text + (dimension == 3 ? fmt::format(", {})", line.x[2][i]) : ")");
}

Line weigh_line(const Lattice& lattice, std::size_t number, const std::vector<Carried>& carried) {
  const std::size_t length = lattice.points[0];
  Line line;
  line.first = number * length;
  line.x[0] = lattice.nodes(0);
  line.x[1].assign(length, lattice.coordinate(1, number % lattice.points[1]));
  line.x[2].assign(length, lattice.coordinate(2, number / lattice.points[1]));
  PointsView points{lattice.dimension, length, {}};
  for (int a = 0; a < lattice.dimension; ++a) points.axis[a] = line.x[a].data();
  const double cell = std::pow(lattice.spacing, lattice.dimension);
  for (const Carried& kind : carried) {
    std::vector<double>& weights = line.weights.emplace_back(length, 0.0);
    kind.density(points, weights.data());
    for (std::size_t i = 0; i < length; ++i) {
      if (!std::isfinite(weights[i]))
        throw NumericalError(fmt::format(
            "{} is {} at {}; it must be finite on the whole domain: guard the expression, or move the domain",
            kind.name, std::isnan(weights[i]) ? "nan" : fmt::format("{}", weights[i]),
            place_text(line, i, lattice.dimension)));
      weights[i] *= cell;
    }
  }
  return line;
}

// Roughly, for a density with an exponential or two.
double seeding_seconds(const Lattice& lattice, const std::vector<Carried>& carried) {
  return 50e-9 * static_cast<double>(lattice.size() * carried.size());
}

// The particles of one line; lines are joined in their order.
struct Part {
  Particles particles;
  SeedReport report;
};

Part seed_line(const Lattice& lattice, std::size_t number, const std::vector<Carried>& carried,
               const std::vector<double>& least) {
  const Line line = weigh_line(lattice, number, carried);
  Part part;
  part.particles.dimension = lattice.dimension;
  part.report.carried.resize(carried.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    bool something = false, enough = false;
    for (std::size_t q = 0; q < carried.size(); ++q) {
      const double size = std::abs(line.weights[q][i]);
      something = something || size > 0;
      enough = enough || (size > 0 && size >= least[q]);
    }
    for (std::size_t q = 0; q < carried.size(); ++q) {
      const double size = std::abs(line.weights[q][i]);
      part.report.carried[q].all += size;
      if (!enough) part.report.carried[q].left_out += size;
    }
    if (something && !enough) ++part.report.left_out;
    if (!enough) continue;
    for (int a = 0; a < lattice.dimension; ++a) part.particles.position[a].push_back(line.x[a][i]);
    part.particles.alpha.push_back(line.weights.front()[i]);
    part.particles.id.push_back(static_cast<std::int64_t>(line.first + i));
  }
  return part;
}

// The smallest weight of each kind that is enough. Lines are weighed twice, so that what is left out is never kept.
std::vector<double> least_weights(const Lattice& lattice, const std::vector<Carried>& carried, double threshold,
                                  std::size_t lines, int threads) {
  std::vector<double> least(carried.size(), 0.0);
  if (!(threshold > 0)) return least;
  std::vector<std::vector<double>> largest(lines, least);
  base::parallel_for({lines, seeding_seconds(lattice, carried)}, threads, [&](std::size_t number) {
    const Line line = weigh_line(lattice, number, carried);
    for (std::size_t q = 0; q < carried.size(); ++q)
      for (const double weight : line.weights[q]) largest[number][q] = std::max(largest[number][q], std::abs(weight));
  });
  for (const auto& of_line : largest)
    for (std::size_t q = 0; q < carried.size(); ++q) least[q] = std::max(least[q], threshold * of_line[q]);
  return least;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Particles seed(const Lattice& lattice, const std::vector<Carried>& carried, double threshold, int threads,
               SeedReport* report) {
  const std::size_t lines = lattice.points[1] * lattice.points[2];
  const std::vector<double> least = least_weights(lattice, carried, threshold, lines, threads);
  std::vector<Part> parts(lines);
  base::parallel_for({lines, seeding_seconds(lattice, carried)}, threads,
                     [&](std::size_t number) { parts[number] = seed_line(lattice, number, carried, least); });
  Particles all;
  all.dimension = lattice.dimension;
  SeedReport total;
  total.carried.resize(carried.size());
  for (Part& part : parts) {
    for (int a = 0; a < lattice.dimension; ++a) append(all.position[a], part.particles.position[a]);
    append(all.alpha, part.particles.alpha);
    append(all.id, part.particles.id);
    total.left_out += part.report.left_out;
    for (std::size_t q = 0; q < carried.size(); ++q) {
      total.carried[q].all += part.report.carried[q].all;
      total.carried[q].left_out += part.report.carried[q].left_out;
    }
    part = {};
  }
  if (report) *report = std::move(total);
  return all;
}

Particles seed(const Lattice& lattice, const DensityFunction& rho_0, int threads) {
  return seed(lattice, {{"the initial density", rho_0}}, 0, threads);
}

double largest_stretch(const Particles& particles, const Lattice& lattice) {
  double heaviest = 0, longest = 0;
  for (const double alpha : particles.alpha) heaviest = std::max(heaviest, std::abs(alpha));
  const double light = 1e-6 * heaviest;
  std::size_t stride = 1;
  for (int k = 0; k < particles.dimension; ++k) {
    std::size_t next = 0;  // ids ascend, so that of the neighbour is found by going along
    for (std::size_t j = 0; j < particles.size(); ++j) {
      const auto id = static_cast<std::size_t>(particles.id[j]);
      if (id / stride % lattice.points[k] + 1 == lattice.points[k]) continue;
      while (next < particles.size() && static_cast<std::size_t>(particles.id[next]) < id + stride) ++next;
      if (next == particles.size() || static_cast<std::size_t>(particles.id[next]) != id + stride) continue;
      if (std::abs(particles.alpha[j]) < light && std::abs(particles.alpha[next]) < light) continue;
      double square = 0;
      for (int a = 0; a < particles.dimension; ++a) {
        const double distance = particles.position[a][j] - particles.position[a][next];
        square += distance * distance;
      }
      longest = std::max(longest, square);
    }
    stride *= lattice.points[k];
  }
  return std::sqrt(longest) / lattice.spacing;
}

}  // namespace gaussdrift
