#include "farfield/tree/transformation.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace farfield::detail {
namespace {

constexpr std::size_t piece = 64;  // parents handled together

template <int d>
PerCluster zeros(const Tree<d>& tree, std::size_t functions) {
  PerCluster numbers(tree.clusters().size() * functions);
  std::fill(numbers.begin(), numbers.end(), 0.0);
  return numbers;
}

/// Pieces of the clusters of one level: work(scratch, begin, end).
template <class Scratch, class Work>
void for_each_piece(std::size_t begin, std::size_t end, double seconds, int threads, const Work& work) {
  gaussdrift::base::parallel_for(
      {(end - begin + piece - 1) / piece, seconds}, threads, [] { return Scratch{}; },
      [&](Scratch& scratch, std::size_t p) {
        work(scratch, begin + p * piece, std::min(end, begin + (p + 1) * piece));
      });
}

/// Seconds of one level: clusters from or to their parents, and the points of its leaves.
template <int d>
double level_seconds(const Tree<d>& tree, std::size_t level, std::size_t functions, bool at_sources) {
  const double numbers = static_cast<double>(functions), a_function = at_sources ? 0.9e-9 : 1.8e-9;
  double points = 0;
  for (std::size_t i = tree.level_begin(level); i < tree.level_begin(level + 1); ++i) {
    const Cluster& cluster = tree.clusters()[i];
    if (cluster.leaf()) points += static_cast<double>(at_sources ? cluster.source_count() : cluster.target_count());
  }
  const auto clusters = static_cast<double>(tree.level_begin(level + 1) - tree.level_begin(level));
  return clusters * numbers * (numbers * 0.07e-9 + 3e-9) + points * numbers * a_function;
}

struct Rows {
  Buffer<double> from, to;
  std::vector<Index> cluster;  // that the rows belong to
};

/// to[i] += from[i] (1 x count) times matrix, for all rows together.
void multiply(Rows& rows, std::size_t count, const double* matrix) {
  rows.to.assign(rows.cluster.size() * count, 0.0);
  fastest_kernels().product({.rows = rows.cluster.size(),
                             .depth = count,
                             .width = count,
                             .a = rows.from.data(),
                             .a_stride = count,
                             .b = matrix,
                             .b_stride = count,
                             .c = rows.to.data(),
                             .c_stride = count});
}

/// Rows for the children in one octant of some of the parents begin .. end that have something to add: their own numbers,
/// or those of the parents.
template <int d, class Some, class Adds>
void gather(const Tree<d>& tree, std::size_t begin, std::size_t end, std::size_t octant, bool of_parents,
            const Some& some, const Adds& adds, const PerCluster& numbers, std::size_t count, Rows& rows) {
  rows.cluster.clear();
  rows.from.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const Cluster& parent = tree.clusters()[i];
    if (!some(parent)) continue;
    for (Index c = parent.first_child; c < parent.first_child + parent.children; ++c) {
      const Cluster& child = tree.clusters()[c];
      if (child.octant != octant || !adds(child)) continue;
      const double* const from = numbers.data() + (of_parents ? i : c) * count;
      rows.cluster.push_back(c);
      rows.from.insert(rows.from.end(), from, from + count);
    }
  }
}

template <int d, class Job>
void set_cluster(const Tree<d>& tree, const Cluster& cluster, const Operators<d>& operators, const Coordinates& points,
                 Job& job) {
  job.dimension = d;
  job.degree = operators.degree();
  job.up = operators.up();
  job.back = operators.back();
  for (std::size_t l = 0; l < d; ++l) {
    job.point[l] = points[l].data();
    job.centre[l] = tree.centre(cluster, l);
  }
  job.scale = stretch / tree.side(cluster.level);
}

/// Moments of the parents begin .. end that are of a part, from those of their children.
template <int d>
void add_children(const Tree<d>& tree, const Operators<d>& operators, Part part, std::size_t begin, std::size_t end,
                  Rows& rows, PerCluster& moments) {
  const std::size_t count = operators.functions();
  const auto some = [part](const Cluster& parent) { return parent.part == part; };
  const auto adds = [](const Cluster& child) { return child.source_count() > 0; };
  for (std::size_t octant = 0; octant < Operators<d>::octants; ++octant) {
    gather<d>(tree, begin, end, octant, false, some, adds, moments, count, rows);
    if (rows.cluster.empty()) continue;
    multiply(rows, count, operators.transfer(octant));
    for (std::size_t row = 0; row < rows.cluster.size(); ++row) {
      double* const parent = moments.data() + tree.clusters()[rows.cluster[row]].parent * count;
      for (std::size_t k = 0; k < count; ++k) parent[k] += rows.to[row * count + k];
    }
  }
}

}  // namespace

template <int d>
PerCluster forward(const Tree<d>& tree, const Operators<d>& operators, const Buffer<double>& charges, int threads) {
  const std::size_t count = operators.functions();
  PerCluster moments = zeros(tree, count);
  for (std::size_t level = tree.levels(); level-- > 0;) {
    for_each_piece<Rows>(tree.level_begin(level), tree.level_begin(level + 1),
                         level_seconds<d>(tree, level, count, true), threads,
                         [&](Rows& rows, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i) {
                             const Cluster& cluster = tree.clusters()[i];
                             if (!cluster.leaf() || cluster.source_count() == 0 || cluster.part != Part::own) continue;
                             MomentsJob job{};
                             set_cluster(tree, cluster, operators, tree.sources().position, job);
                             rows.to.resize(count * max_lanes);
                             rows.from.resize(count);
                             job.charge = charges.data();
                             job.range = cluster.sources;
                             job.moments = rows.from.data();
                             job.scratch = rows.to.data();
                             fastest_kernels().moments(job);
                             for (std::size_t k = 0; k < count; ++k)
                               moments[i * count + operators.place(k)] = rows.from[k];
                           }
                           add_children<d>(tree, operators, Part::own, begin, end, rows, moments);
                         });
  }
  return moments;
}

template <int d>
void forward_shared(const Tree<d>& tree, const Operators<d>& operators, int threads, PerCluster& moments) {
  for (std::size_t level = tree.levels(); level-- > 0;)
    for_each_piece<Rows>(tree.level_begin(level), tree.level_begin(level + 1), 0, threads,
                         [&](Rows& rows, std::size_t begin, std::size_t end) {
                           add_children<d>(tree, operators, Part::shared, begin, end, rows, moments);
                         });
}

template <int d>
void backward(const Tree<d>& tree, const Operators<d>& operators, PerCluster& coefficients, double sign, bool potential,
              int threads, Sums& sums) {
  const std::size_t count = operators.functions();
  const auto all = [](const Cluster&) { return true; };
  const auto takes = [](const Cluster& child) { return child.target_count() > 0; };
  for (std::size_t level = 0; level < tree.levels(); ++level) {
    for_each_piece<Rows>(tree.level_begin(level), tree.level_begin(level + 1),
                         level_seconds<d>(tree, level, count, false), threads,
                         [&](Rows& rows, std::size_t begin, std::size_t end) {
                           for (std::size_t octant = 0; octant < Operators<d>::octants; ++octant) {
                             gather<d>(tree, begin, end, octant, true, all, takes, coefficients, count, rows);
                             if (rows.cluster.empty()) continue;
                             multiply(rows, count, operators.transposed(octant));
                             for (std::size_t row = 0; row < rows.cluster.size(); ++row) {
                               double* const child = coefficients.data() + rows.cluster[row] * count;
                               for (std::size_t k = 0; k < count; ++k) child[k] += rows.to[row * count + k];
                             }
                           }
                           for (std::size_t i = begin; i < end; ++i) {
                             const Cluster& cluster = tree.clusters()[i];
                             if (!cluster.leaf() || cluster.target_count() == 0) continue;
                             ExpansionJob job{};
                             set_cluster(tree, cluster, operators, tree.targets().position, job);
                             rows.to.resize(d * count);
                             rows.from.resize(count);
                             operators.in_order(coefficients.data() + i * count, rows.from.data());
                             double* derivative[d];
                             for (std::size_t l = 0; l < d; ++l) derivative[l] = rows.to.data() + l * count;
                             job.coefficient[0] = rows.from.data();
                             differentiate<d>(operators.degree(), job.coefficient[0], derivative);
                             job.range = cluster.targets;
                             job.field_scale = sign * job.scale;
                             for (std::size_t l = 0; l < d; ++l) {
                               job.coefficient[1 + l] = derivative[l];
                               job.field[l] = sums.field[l].data();
                             }
                             job.potential = potential ? sums.potential.data() : nullptr;
                             fastest_kernels().expansion(job);
                           }
                         });
  }
}

template PerCluster forward<2>(const Tree<2>&, const Operators<2>&, const Buffer<double>&, int);
template PerCluster forward<3>(const Tree<3>&, const Operators<3>&, const Buffer<double>&, int);
template void forward_shared<2>(const Tree<2>&, const Operators<2>&, int, PerCluster&);
template void forward_shared<3>(const Tree<3>&, const Operators<3>&, int, PerCluster&);
template void backward<2>(const Tree<2>&, const Operators<2>&, PerCluster&, double, bool, int, Sums&);
template void backward<3>(const Tree<3>&, const Operators<3>&, PerCluster&, double, bool, int, Sums&);

}  // namespace farfield::detail
