#include "farfield/near/near_field.hpp"

#include <algorithm>
#include <cmath>

namespace farfield::detail {
namespace {

constexpr std::size_t substitutes_together = 1024;
constexpr double substitutes_larger = 10;

/// Largest distance along an axis of some points from a centre.
template <int d>
double reach_from(const double* centre, const Coordinates& points, Range range) {
  constexpr std::size_t together = 8;  // so that the compiler takes vectors
  double reach = 0;
  for (std::size_t l = 0; l < d; ++l) {
    double low[together], high[together];
    std::fill_n(low, together, HUGE_VAL);
    std::fill_n(high, together, -HUGE_VAL);
    const auto include = [&](std::size_t j, std::size_t i) {
      const double x = points[l][j];
      low[i] = x < low[i] ? x : low[i];
      high[i] = x > high[i] ? x : high[i];
    };
    std::size_t j = range.begin;
    for (; j + together <= range.end; j += together)
      for (std::size_t i = 0; i < together; ++i) include(j + i, i);
    for (; j < range.end; ++j) include(j, 0);
    reach = std::max({reach, *std::max_element(high, high + together) - centre[l],
                      centre[l] - *std::min_element(low, low + together)});
  }
  return reach;
}

}  // namespace

// six digits: a step of Newton's method leaves 2e-7 of 1/r, so 6e-7 of 1/r^3; whole coordinates 1e-6 of 1/r^2 at the
// closest; 64 additions 64 half units in the last place of float at worst
double error_of(Precision precision) {
  switch (precision) {
    case Precision::six_digits:
      return 6e-6;
    case Precision::ten_digits:
      return 1e-9;
    default:
      return 1e-14;
  }
}

Precisions precisions_for(double tolerance, Interaction interaction) {
  const double point_beyond = std::min(40.0, std::log(10 / tolerance));
  if (interaction != Interaction::inverse) return {Precision::full, Precision::full, point_beyond};
  const auto best = [&](double loss) {
    for (const Precision precision : {Precision::six_digits, Precision::ten_digits})
      if (loss * error_of(precision) <= tolerance) return precision;
    return Precision::full;
  };
  return {best(1), best(4 * substitutes_larger), point_beyond};
}

double substitution_error(Precision precision) { return substitutes_larger * error_of(precision); }

template <int d>
PairsJob NearField<d>::job_for(const Cluster& leaf, Sums& sums) const {
  PairsJob job{};
  job.interaction = problem_.interaction;
  job.precision = precisions_.points;
  const Coordinates& target = tree_.targets().position;
  for (std::size_t l = 0; l < d; ++l) {
    job.target[l] = target[l].data();
    job.field[l] = sums.field[l].data();
    job.centre[l] = tree_.centre(leaf, l);
  }
  job.targets = leaf.targets;
  job.log_shift = problem_.log_shift;
  job.inverse_squared_core = problem_.inverse_squared_core;
  job.point_beyond = precisions_.point_beyond;
  job.potential = problem_.potential ? sums.potential.data() : nullptr;
  return job;
}

template <int d>
void NearField<d>::add(const Cluster& leaf, const Range* runs, std::size_t count, const Buffer<double>& charges,
                       Sums& sums) const {
  if (count == 0) return;
  PairsJob job = job_for(leaf, sums);
  const Coordinates& source = tree_.sources().position;
  for (std::size_t l = 0; l < d; ++l) job.source[l] = source[l].data();
  job.charge = charges.data();
  job.runs = runs;
  job.run_count = count;
  job.same_points = problem_.self;
  if (job.precision != Precision::six_digits) return fastest_kernels().pairs(job);

  // Runs that reach equally far go together; larger leaves far beyond this one are summed in double.
  const double side = tree_.side(leaf.level), farthest_in_float = 32 * side;
  const auto reach_of = [&](const Range& run) {
    const double reach = reach_from<d>(job.centre, source, run);
    double rounded = 2 * side;
    while (rounded < reach && rounded <= farthest_in_float) rounded *= 2;
    return rounded;
  };
  double reach = reach_of(runs[0]), next = reach;
  for (std::size_t first = 0, last = 1; first < count; first = last++, reach = next) {
    while (last < count && (next = reach_of(runs[last])) == reach) ++last;
    if (reach <= farthest_in_float) {
      set_reach(reach, job);
    } else {
      job.precision = Precision::ten_digits;
    }
    job.runs = runs + first;
    job.run_count = last - first;
    fastest_kernels().pairs(job);
  }
}

template <int d>
void NearField<d>::set_reach(double reach, PairsJob& job) {
  job.precision = Precision::six_digits;
  job.quantum = reach * 0x1p-29;
  job.closest = job.quantum * 0x1p21;
}

template <int d>
void NearField<d>::nodes_of(const Cluster& cluster, const Interpolation<d>& interpolation, Coordinates& to,
                            std::size_t first) const {
  const double side = tree_.side(cluster.level);
  const std::size_t octant = interpolation.octant();
  for (std::size_t l = 0; l < d; ++l) {
    const double centre = tree_.centre(cluster, l);
    for (std::size_t s = 0; s < Interpolation<d>::reflections; ++s)
      for (std::size_t i = 0; i < octant; ++i)
        to[l][first + s * octant + i] = centre + side * interpolation.node(s, i, l);
  }
}

template <int d>
void NearField<d>::add(const Cluster& leaf, const Interpolation<d>& interpolation, const Cluster& sources,
                       Substitutes& substitutes, Sums& sums) const {
  const std::size_t nodes = interpolation.nodes();
  if (substitutes.charge.empty()) {
    for (std::size_t l = 0; l < d; ++l) substitutes.position[l].assign(substitutes_together + nodes + padding, 0.0);
    substitutes.charge.assign(substitutes_together + nodes + padding, 0.0);
  }
  nodes_of(sources, interpolation, substitutes.position, substitutes.count);
  interpolation.substitute(substitutes.moments.data(), substitutes.charge.data() + substitutes.count);
  substitutes.count += nodes;
  for (std::size_t l = 0; l < d; ++l)
    substitutes.reach = std::max(
        substitutes.reach, std::abs(tree_.centre(sources, l) - tree_.centre(leaf, l)) + tree_.side(sources.level));
  if (substitutes.count >= substitutes_together) act(leaf, substitutes, sums);
}

template <int d>
void NearField<d>::act(const Cluster& leaf, Substitutes& substitutes, Sums& sums) const {
  if (substitutes.count == 0) return;
  PairsJob job = job_for(leaf, sums);
  if (job.interaction == Interaction::blob) job.interaction = Interaction::logarithm;
  for (std::size_t l = 0; l < d; ++l) job.source[l] = substitutes.position[l].data();
  job.charge = substitutes.charge.data();
  job.same_points = false;
  const Range all{0, substitutes.count};
  job.runs = &all;
  job.run_count = 1;
  job.precision = precisions_.substitutes;
  if (job.precision == Precision::six_digits) set_reach(substitutes.reach, job);
  fastest_kernels().pairs(job);
  substitutes.count = 0;
  substitutes.reach = 0;
}

template <int d>
void NearField<d>::at_nodes(const Cluster& cluster, const Interpolation<d>& interpolation, Range range,
                            const Buffer<double>& charges, double* values) const {
  Coordinates node;
  const std::size_t nodes = interpolation.nodes();
  for (std::size_t l = 0; l < d; ++l) node[l].assign(nodes + padding, 0.0);
  nodes_of(cluster, interpolation, node, 0);
  PairsJob job{};
  job.interaction = d == 3 ? Interaction::inverse : Interaction::logarithm;
  job.precision = Precision::full;
  for (std::size_t l = 0; l < d; ++l) {
    job.target[l] = node[l].data();
    job.source[l] = tree_.sources().position[l].data();
  }
  job.targets = {0, nodes};
  job.charge = charges.data();
  job.runs = &range;
  job.run_count = 1;
  Buffer<double> potential(nodes + padding);
  std::fill(potential.begin(), potential.end(), 0.0);
  job.potential = potential.data();
  fastest_kernels().pairs(job);
  std::copy_n(potential.begin(), nodes, values);
}

template class NearField<2>;
template class NearField<3>;

}  // namespace farfield::detail
