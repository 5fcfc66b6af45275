#include "sim/follow/density_at_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "base/parallel.hpp"
#include "particle/placing.hpp"
#include "particle/subset.hpp"
#include "sim/blob_sum.hpp"
#include "sim/tiled_density.hpp"

namespace gaussdrift {

namespace {

/// A cube with sides as long as blobs reach. What is felt in one lies in it or in one beside it.
using Cell = std::array<std::int64_t, max_dimension>;

template <class Coordinate>
Cell cell_of(int dimension, double side, const Coordinate& coordinate) {
  constexpr double farthest = 1e15;  // so that it is a number of a cell
  Cell cell{};
  for (int k = 0; k < dimension; ++k)
    cell[static_cast<std::size_t>(k)] =
        static_cast<std::int64_t>(std::clamp(std::floor(coordinate(k) / side), -farthest, farthest));
  return cell;
}

/// Calls visit(cell) for a cell and those around it.
template <class Visit>
void for_cells_around(const Cell& cell, int dimension, const Visit& visit) {
  const std::int64_t deep = dimension == 3 ? 1 : 0;
  for (std::int64_t c = -deep; c <= deep; ++c)
    for (std::int64_t b = -1; b <= 1; ++b)
      for (std::int64_t a = -1; a <= 1; ++a) visit(Cell{cell[0] + a, cell[1] + b, cell[2] + c});
}

/// The points of a cell, and the particles that are felt there, by their numbers.
struct Group {
  std::vector<std::size_t> points, particles;
};

std::map<Cell, Group> groups_of(const std::vector<double>& points, int dimension, double side) {
  std::map<Cell, Group> groups;
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t j = 0; j < points.size() / d; ++j)
    groups[cell_of(dimension, side, [&](int k) { return points[j * d + static_cast<std::size_t>(k)]; })]
        .points.push_back(j);
  return groups;
}

/// Gives each group its particles; the numbers of all that any group has.
std::vector<std::size_t> fill(std::map<Cell, Group>& groups, const Particles& particles, double side) {
  std::vector<std::size_t> felt;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const Cell cell =
        cell_of(particles.dimension, side, [&](int k) { return particles.position[static_cast<std::size_t>(k)][j]; });
    bool some = false;
    for_cells_around(cell, particles.dimension, [&](const Cell& near) {
      if (const auto found = groups.find(near); found != groups.end())
        found->second.particles.push_back(j), some = true;
    });
    if (some) felt.push_back(j);
  }
  return felt;
}

template <int d, int e>
void sum_group(const Particles& felt, const Group& group, const Cutoff& cutoff, const DensityOptions& options,
               const std::vector<double>& points, std::vector<std::vector<double>>& values) {
  if (group.particles.empty()) return;
  const BlobSum<d, e> sum(subset(felt, group.particles), cutoff, options);
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(group.points.size()));
  for (std::size_t i = 0; i < group.points.size(); ++i)
    for (std::size_t k = 0; k < d; ++k)
      targets(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = points[group.points[i] * d + k];
  const Eigen::MatrixXd sums = sum.direct(targets);
  for (std::size_t q = 0; q < values.size(); ++q)
    for (std::size_t i = 0; i < group.points.size(); ++i)
      values[q][group.points[i]] = sums(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(q));
}

// The sums of all groups, of particles by id.
std::vector<std::vector<double>> sums_of(const Particles& felt, std::map<Cell, Group>& groups, double side,
                                         const Cutoff& cutoff, const DensityOptions& options,
                                         const std::vector<double>& wanted) {
  for (auto& [cell, group] : groups) group.particles.clear();
  fill(groups, felt, side);
  std::vector<std::vector<double>> values(
      options.quantities(), std::vector<double>(wanted.size() / static_cast<std::size_t>(felt.dimension), 0.0));
  double pairs = 0;
  std::vector<const Group*> list;
  for (const auto& [cell, group] : groups) {
    list.push_back(&group);
    pairs += static_cast<double>(group.points.size()) * static_cast<double>(group.particles.size());
  }
  DensityOptions of_group = options;
  of_group.threads = 1;
  constexpr double seconds_of_a_pair = 1e-8;
  base::parallel_for({list.size(), pairs * seconds_of_a_pair}, options.threads, [&](std::size_t number) {
    in_dimensions(felt.dimension, cutoff,
                  [&](auto d, auto e) { sum_group<d, e>(felt, *list[number], cutoff, of_group, wanted, values); });
  });
  return values;
}

}  // namespace

std::vector<std::vector<double>> density_at_points(const Particles& particles, const Cutoff& cutoff,
                                                   const DensityOptions& options, const std::vector<double>& points,
                                                   base::Communicator& ranks) {
  base::Bytes bytes = base::to_bytes(points);
  ranks.broadcast(bytes);
  const auto wanted = base::from_bytes<double>(bytes);
  constexpr double whole_sphere = 360;  // near a pole a short way crosses many longitudes
  const double side = sphere_of(cutoff) > 0 ? whole_sphere : reach_of_blob(cutoff, options);
  std::map<Cell, Group> groups = groups_of(wanted, particles.dimension, side);
  std::vector<base::Bytes> arrived = ranks.gather(pack_bare(particles, fill(groups, particles, side)));
  std::vector<std::vector<double>> values;
  ranks.agree_on([&] {
    if (ranks.rank() != 0) return;
    Particles felt;
    felt.dimension = particles.dimension;
    for (const base::Bytes& some : arrived) unpack(some, felt);
    sort_by_id(felt);
    values = sums_of(felt, groups, side, cutoff, options, wanted);
  });
  return values;
}

}  // namespace gaussdrift
