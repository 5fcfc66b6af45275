#include "particle/seeding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.hpp"
#include "base/sphere.hpp"
#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"

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
  const double cell = lattice.cell(line.x[1].front());
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

std::size_t tracers_of(const std::vector<Carried>& carried) {
  return static_cast<std::size_t>(
      std::count_if(carried.begin(), carried.end(), [](const Carried& one) { return one.is_tracer; }));
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
  part.particles.tracers.resize(tracers_of(carried));
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
    double sum = 0;
    for (std::size_t q = 0, k = 0; q < carried.size(); ++q)
      if (carried[q].is_tracer) part.particles.tracers[k++].push_back(line.weights[q][i]), sum += line.weights[q][i];
    if (!part.particles.tracers.empty()) part.particles.alpha.back() = sum;
    part.particles.id.push_back(static_cast<std::int64_t>(line.first + i));
  }
  return part;
}

// Which lines a rank has: every N-th one.
struct Lines {
  Lines(std::size_t lines, const base::Communicator& ranks)
      : all(lines), first(static_cast<std::size_t>(ranks.rank())), step(static_cast<std::size_t>(ranks.size())) {
    own = all > first ? (all - first - 1) / step + 1 : 0;
  }
  std::size_t number(std::size_t i) const { return first + i * step; }
  double part() const { return static_cast<double>(own) / static_cast<double>(all); }

  std::size_t all, first, step, own = 0;
};

// The smallest weight of each kind that is enough. Lines are weighed twice, so that what is left out is never kept.
std::vector<double> least_weights(const Lattice& lattice, const std::vector<Carried>& carried, double threshold,
                                  const Lines& lines, int threads) {
  std::vector<double> least(carried.size(), 0.0);
  if (!(threshold > 0)) return least;
  std::vector<std::vector<double>> largest(lines.own, least);
  base::parallel_for({lines.own, lines.part() * seeding_seconds(lattice, carried)}, threads, [&](std::size_t own) {
    const Line line = weigh_line(lattice, lines.number(own), carried);
    for (std::size_t q = 0; q < carried.size(); ++q)
      for (const double weight : line.weights[q]) largest[own][q] = std::max(largest[own][q], std::abs(weight));
  });
  for (const auto& of_line : largest)
    for (std::size_t q = 0; q < carried.size(); ++q) least[q] = std::max(least[q], threshold * of_line[q]);
  return least;
}

// In the order of lines, so that it does not depend on who has which.
SeedReport sum_of_lines(const std::vector<double>& columns, std::size_t kinds, const Lines& lines,
                        base::Communicator& ranks) {
  std::vector<std::vector<double>> of_ranks;
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(columns)))
    of_ranks.push_back(base::from_bytes<double>(bytes));
  const std::size_t width = 1 + 2 * kinds;
  std::vector<double> sums(width, 0.0);
  if (ranks.rank() == 0)
    for (std::size_t line = 0; line < lines.all; ++line)
      for (std::size_t c = 0; c < width; ++c) sums[c] += of_ranks[line % lines.step][line / lines.step * width + c];
  base::Bytes bytes = base::to_bytes(sums);
  ranks.broadcast(bytes);
  sums = base::from_bytes<double>(bytes);
  SeedReport total;
  total.left_out = static_cast<std::size_t>(sums[0]);
  for (std::size_t q = 0; q < kinds; ++q) total.carried.push_back({sums[1 + 2 * q], sums[2 + 2 * q]});
  return total;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Particles seed(const Lattice& lattice, const std::vector<Carried>& carried, double threshold, int threads,
               SeedReport* report) {
  base::Communicator alone;
  return seed(lattice, carried, threshold, threads, report, alone);
}

Particles seed(const Lattice& lattice, const std::vector<Carried>& carried, double threshold, int threads,
               SeedReport* report, base::Communicator& ranks) {
  const Lines lines(lattice.points[1] * lattice.points[2], ranks);
  std::vector<double> least;
  ranks.agree_on([&] { least = least_weights(lattice, carried, threshold, lines, threads); });
  ranks.max(std::span(least));
  Particles all;
  all.dimension = lattice.dimension;
  all.tracers.resize(tracers_of(carried));
  std::vector<double> columns;  // of the reports, line by line: points left out, then all and left_out of each kind
  // Some lines at a time, so that little stands twice in memory.
  const std::size_t batch = std::max<std::size_t>(64, 1'000'000 / lattice.points[0]);
  std::vector<Part> parts;
  ranks.agree_on([&] {
    for (std::size_t first = 0; first < lines.own; first += batch) {
      parts.resize(std::min(batch, lines.own - first));
      const double share = static_cast<double>(parts.size()) / static_cast<double>(lines.all);
      base::parallel_for({parts.size(), share * seeding_seconds(lattice, carried)}, threads, [&](std::size_t i) {
        parts[i] = seed_line(lattice, lines.number(first + i), carried, least);
      });
      for (Part& part : parts) {
        for (int a = 0; a < lattice.dimension; ++a) append(all.position[a], part.particles.position[a]);
        append(all.alpha, part.particles.alpha);
        for (std::size_t k = 0; k < all.tracers.size(); ++k) append(all.tracers[k], part.particles.tracers[k]);
        append(all.id, part.particles.id);
        columns.push_back(static_cast<double>(part.report.left_out));
        for (const LeftOut& kind : part.report.carried) {
          columns.push_back(kind.all);
          columns.push_back(kind.left_out);
        }
        part = {};
      }
    }
    for (int a = 0; a < lattice.dimension; ++a) all.position[a].shrink_to_fit();
    all.alpha.shrink_to_fit();
    for (auto& tracer : all.tracers) tracer.shrink_to_fit();
    all.id.shrink_to_fit();
  });
  if (report) *report = sum_of_lines(columns, carried.size(), lines, ranks);
  return all;
}

Particles seed(const Lattice& lattice, const DensityFunction& rho_0, int threads) {
  return seed(lattice, {{"the initial density", rho_0}}, 0, threads);
}

namespace {

// Those of the lattice; released ones have ids beyond it and come last.
std::size_t of_lattice(const Particles& particles, const Lattice& lattice) {
  const auto end = static_cast<std::int64_t>(lattice.size());
  return static_cast<std::size_t>(std::lower_bound(particles.id.begin(), particles.id.end(), end) -
                                  particles.id.begin());
}

// Squares of the distances of lattice neighbours that are both here. `light`: pairs of two weights below do not count.
// Calls alone(j) for a particle without one of its neighbours on the lattice, if that is wanted.
template <class Alone>
double longest_square(const Particles& particles, const Lattice& lattice, const Folding& folding, double light,
                      const Alone& alone) {
  double longest = 0;
  std::size_t stride = 1;
  const std::size_t count = of_lattice(particles, lattice);
  std::vector<char> met;  // from below
  for (int k = 0; k < particles.dimension; ++k) {
    std::size_t next = 0;  // ids ascend, so that of the neighbour is found by going along
    met.assign(count, 0);
    for (std::size_t j = 0; j < count; ++j) {
      const auto id = static_cast<std::size_t>(particles.id[j]);
      if (!met[j] && id / stride % lattice.points[k] > 0) alone(j);
      if (id / stride % lattice.points[k] + 1 == lattice.points[k]) continue;
      while (next < count && static_cast<std::size_t>(particles.id[next]) < id + stride) ++next;
      if (next == count || static_cast<std::size_t>(particles.id[next]) != id + stride) {
        alone(j);
        continue;
      }
      met[next] = 1;
      if (std::abs(particles.alpha[j]) < light && std::abs(particles.alpha[next]) < light) continue;
      double square = 0;
      if (lattice.sphere > 0) {
        const PointsView places = particles.view();
        longest = std::max(longest, std::pow(degrees(angle_between(places.at(j), places.at(next))), 2));
        continue;
      }
      for (int a = 0; a < particles.dimension; ++a) {
        double distance = particles.position[a][j] - particles.position[a][next];
        if (const FoldedAxis& axis = folding.axis(a); axis.periodic)
          distance = std::remainder(distance, axis.high - axis.low);
        square += distance * distance;
      }
      longest = std::max(longest, square);
    }
    stride *= lattice.points[k];
  }
  return longest;
}

double heaviest(const Particles& particles, const Lattice& lattice) {
  double largest = 0;
  const std::size_t count = of_lattice(particles, lattice);
  for (std::size_t j = 0; j < count; ++j) largest = std::max(largest, std::abs(particles.alpha[j]));
  return largest;
}

}  // namespace

double largest_stretch(const Particles& particles, const Lattice& lattice, const Folding& folding) {
  return std::sqrt(
             longest_square(particles, lattice, folding, 1e-6 * heaviest(particles, lattice), [](std::size_t) {})) /
         lattice.spacing;
}

double largest_stretch(const Particles& particles, const Lattice& lattice, base::Communicator& ranks,
                       const Folding& folding) {
  if (ranks.size() == 1) return largest_stretch(particles, lattice, folding);
  double heavy = heaviest(particles, lattice);
  ranks.max(std::span(&heavy, 1));
  // Those without a neighbour here meet on the rank that has the range of its id: few, where tiles are compact.
  const std::size_t range = lattice.size() / static_cast<std::size_t>(ranks.size()) + 1;
  std::vector<std::vector<std::size_t>> chosen(static_cast<std::size_t>(ranks.size()));
  const auto send = [&](std::size_t j, std::size_t id) {
    auto& list = chosen[std::min(id / range, chosen.size() - 1)];
    if (list.empty() || list.back() != j) list.push_back(j);
  };
  double longest = longest_square(particles, lattice, folding, 1e-6 * heavy, [&](std::size_t j) {
    // It may be the lower one or the upper one of a pair on any axis: the lower one says where they meet.
    const auto id = static_cast<std::size_t>(particles.id[j]);
    send(j, id);
    for (std::size_t k = 0, stride = 1; k < static_cast<std::size_t>(particles.dimension); ++k) {
      if (id / stride % lattice.points[k] > 0) send(j, id - stride);
      stride *= lattice.points[k];
    }
  });
  Particles bare;
  bare.dimension = particles.dimension;
  std::vector<base::Bytes> out;
  for (const auto& list : chosen) out.push_back(pack_bare(particles, list));
  for (const base::Bytes& bytes : ranks.exchange(std::move(out))) unpack(bytes, bare);
  sort_by_id(bare);
  longest = std::max(longest, longest_square(bare, lattice, folding, 1e-6 * heavy, [](std::size_t) {}));
  ranks.max(std::span(&longest, 1));
  return std::sqrt(longest) / lattice.spacing;
}

}  // namespace gaussdrift
