#include "farfield/general/h2_matrix.hpp"

#include <algorithm>
#include <bit>

#include "base/parallel.hpp"
#include "farfield/check.hpp"

namespace farfield::detail {

using gaussdrift::base::parallel_for;

namespace {

constexpr std::size_t chunk_targets = 256;
constexpr std::size_t batch = 128;  // couplings at a time

/// c (rows x width) += a (rows x depth) b (depth x width); b is readable past its end.
void add_product(std::size_t rows, std::size_t depth, std::size_t width, const double* a, const double* b, double* c) {
  if (rows * depth * width > 0) fastest_kernels().product({rows, depth, width, a, depth, b, width, c, width});
}

/// A copy of a matrix that is readable past its end.
Buffer<double> padded(const RowMatrix& matrix) {
  Buffer<double> copy(static_cast<std::size_t>(matrix.size()) + padding, 0.0);
  std::copy(matrix.data(), matrix.data() + matrix.size(), copy.begin());
  return copy;
}

double seconds_of(double products) { return 1e-10 * products; }

std::vector<std::uint32_t> coupled_clusters(const GeneralBlocks& blocks, bool targets) {
  std::vector<std::uint32_t> numbers;
  for (const auto& level : blocks.couplings)
    for (const GeneralCoupling& coupling : level) numbers.push_back(targets ? coupling.target : coupling.source);
  return numbers;
}

}  // namespace

ClusterBases H2Matrix::make_bases(GeneralTree& tree, const std::vector<std::uint32_t>& coupled, int threads,
                                  std::size_t memory_limit) const {
  ClusterBases bases;
  const std::size_t leaves = mark_bases(tree, coupled);
  bases.clusters.resize(parts_.bases.size());
  bases.first.assign(tree.size(), 0);
  std::vector<std::uint32_t> leaf(leaves);
  std::size_t numbers = 0;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const GeneralCluster& cluster = tree[i];
    if (!cluster.has_basis) continue;
    const auto level = static_cast<std::size_t>(cluster.level);
    bases.clusters[level].push_back(i);
    bases.first[i] = bases.numbers;
    bases.numbers += parts_.bases[level].rank;
    if (!cluster.leaf) continue;
    bases.leaf_first.push_back(numbers);
    leaf[cluster.leaf_number] = i;
    numbers += cluster.size() * parts_.bases[level].rank;
  }
  check_memory("leaf matrices", 8.0 * static_cast<double>(numbers), memory_limit);
  bases.leaf_matrix.resize(numbers + padding);
  std::fill(bases.leaf_matrix.begin(), bases.leaf_matrix.end(), 0.0);
  double work = 0;
  for (const std::uint32_t i : leaf) {
    const LevelBasis& basis = parts_.bases[static_cast<std::size_t>(tree[i].level)];
    work += static_cast<double>(tree[i].size() * basis.products->size() * basis.rank);
  }
  parallel_for({leaves, seconds_of(work)}, threads, [&](std::size_t k) {
    const GeneralCluster& cluster = tree[leaf[k]];
    const LevelBasis& basis = parts_.bases[static_cast<std::size_t>(cluster.level)];
    const auto size = static_cast<Eigen::Index>(basis.products->size()), rank = static_cast<Eigen::Index>(basis.rank);
    constexpr std::size_t together = 64;  // points
    double* const matrix = bases.leaf_matrix.data() + bases.leaf_first[k];
    const double side = tree.side(cluster.level);
    RowMatrix values(static_cast<Eigen::Index>(together), size);
    for (std::size_t begin = 0; begin < cluster.size(); begin += together) {
      const auto count = static_cast<Eigen::Index>(std::min(together, cluster.size() - begin));
      for (Eigen::Index i = 0; i < count; ++i) {
        double place[3] = {};
        for (int l = 0; l < dimension_; ++l)
          place[l] =
              (tree.points()[static_cast<std::size_t>(l)][cluster.points.begin + begin + static_cast<std::size_t>(i)] -
               tree.centre(cluster, l)) /
              side;
        product_values(*basis.products, place, values.row(i).data());
      }
      Eigen::Map<RowMatrix>(matrix + begin * basis.rank, count, rank) = times_functions(values.topRows(count), basis);
    }
  });
  return bases;
}

H2Matrix::H2Matrix(const KernelData& kernel, int dimension, Parts parts, int threads, std::size_t memory_limit)
    : kernel_(kernel), dimension_(dimension), parts_(std::move(parts)) {
  target_bases_ = make_bases(parts_.targets, coupled_clusters(parts_.blocks, true), threads, memory_limit);
  if (!parts_.self)
    source_bases_ = make_bases(parts_.sources, coupled_clusters(parts_.blocks, false), threads, memory_limit);
  make_chunks();
  for (const LevelBasis& basis : parts_.bases) {
    auto& signs = signs_.emplace_back(8);
    for (unsigned reflection = 0; reflection < 8; ++reflection)
      for (const unsigned parity : basis.parity)
        signs[reflection].push_back(std::popcount(parity & reflection) % 2 == 0 ? 1.0 : -1.0);
  }
  for (const auto& near : parts_.blocks.near) {
    auto& begins = near_targets_.emplace_back();
    for (std::size_t i = 0; i < near.size(); ++i)
      if (i == 0 || near[i].target != near[i - 1].target) begins.push_back(i);
    begins.push_back(near.size());
  }
}

void H2Matrix::make_chunks() {
  for (std::size_t level = 0; level < parts_.blocks.couplings.size(); ++level) {
    auto& couplings = parts_.blocks.couplings[level];
    auto& chunks = chunks_.emplace_back();
    const auto matrix_of = [&](const GeneralCoupling& coupling) {
      return parts_.bases[level].uses[coupling.offset].matrix;
    };
    for (std::size_t begin = 0; begin < couplings.size();) {
      std::size_t end = begin, targets = 0;
      while (end < couplings.size()) {
        const bool next = end == begin || couplings[end].target != couplings[end - 1].target;
        if (next && targets == chunk_targets) break;
        targets += next ? 1 : 0;
        ++end;
      }
      std::stable_sort(couplings.begin() + static_cast<std::ptrdiff_t>(begin),
                       couplings.begin() + static_cast<std::ptrdiff_t>(end),
                       [&](const GeneralCoupling& a, const GeneralCoupling& b) { return matrix_of(a) < matrix_of(b); });
      chunks.push_back({begin, end});
      begin = end;
    }
  }
}

Buffer<double> H2Matrix::forward(const Buffer<double>& charges, int threads) const {
  const ClusterBases& bases = source_bases();
  const GeneralTree& tree = sources();
  Buffer<double> moments(bases.numbers + padding);
  std::fill(moments.begin(), moments.end(), 0.0);
  std::vector<std::vector<Buffer<double>>> transfers(parts_.bases.size());
  for (std::size_t level = 0; level < transfers.size(); ++level)
    for (const RowMatrix& matrix : parts_.bases[level].to_parent) transfers[level].push_back(padded(matrix));
  for (std::size_t level = parts_.bases.size(); level-- > 0;) {
    const std::vector<std::uint32_t>& clusters = bases.clusters[level];
    const std::size_t rank = parts_.bases[level].rank;
    parallel_for({clusters.size(), seconds_of(8.0 * static_cast<double>(clusters.size() * rank * rank))}, threads,
                 [&](std::size_t k) {
                   const GeneralCluster& cluster = tree[clusters[k]];
                   double* const to = moments.data() + bases.first[clusters[k]];
                   if (cluster.leaf) {
                     add_product(1, cluster.size(), rank, charges.data() + cluster.points.begin,
                                 bases.leaf_matrix.data() + bases.leaf_first[cluster.leaf_number], to);
                     return;
                   }
                   const std::size_t child_rank = parts_.bases[level + 1].rank;
                   for (std::uint32_t c = 0; c < cluster.children; ++c) {
                     const std::uint32_t child = cluster.first_child + c;
                     add_product(1, child_rank, rank, moments.data() + bases.first[child],
                                 transfers[level + 1][tree[child].octant].data(), to);
                   }
                 });
  }
  return moments;
}

void H2Matrix::couple(std::size_t level, const Chunk& chunk, const Buffer<double>& moments,
                      Buffer<double>& coefficients) const {
  const LevelBasis& basis = parts_.bases[level];
  const auto& couplings = parts_.blocks.couplings[level];
  std::vector<double> in(batch * basis.rank), out(batch * basis.rank);
  Buffer<double> matrix;
  std::size_t known = basis.matrices.size();
  for (std::size_t begin = chunk.begin; begin < chunk.end;) {
    const std::size_t number = basis.uses[couplings[begin].offset].matrix, size = basis.matrices[number].size();
    std::size_t end = begin + 1;
    while (end < chunk.end && end - begin < batch && basis.uses[couplings[end].offset].matrix == number) ++end;
    if (known != number) {
      matrix = padded(basis.matrices[number].transposed);
      known = number;
    }
    const std::size_t count = end - begin;
    for (std::size_t i = 0; i < count; ++i) {
      const GeneralCoupling& coupling = couplings[begin + i];
      const double* const from = moments.data() + source_bases().first[coupling.source];
      const double* const sign = signs_[level][basis.uses[coupling.offset].reflection].data();
      for (std::size_t k = 0; k < size; ++k) in[i * size + k] = sign[k] * from[k];
    }
    std::fill_n(out.begin(), count * size, 0.0);
    add_product(count, size, size, in.data(), matrix.data(), out.data());
    for (std::size_t i = 0; i < count; ++i) {
      const GeneralCoupling& coupling = couplings[begin + i];
      double* const to = coefficients.data() + target_bases_.first[coupling.target];
      const double* const sign = signs_[level][basis.uses[coupling.offset].reflection].data();
      for (std::size_t k = 0; k < size; ++k) to[k] += sign[k] * out[i * size + k];
    }
    begin = end;
  }
}

void H2Matrix::couple(const Buffer<double>& moments, Buffer<double>& coefficients, int threads) const {
  for (std::size_t level = 0; level < chunks_.size(); ++level) {
    const double rank = static_cast<double>(parts_.bases[level].rank);
    parallel_for(
        {chunks_[level].size(), seconds_of(rank * rank * static_cast<double>(parts_.blocks.couplings[level].size()))},
        threads, [&](std::size_t k) { couple(level, chunks_[level][k], moments, coefficients); });
  }
}

void H2Matrix::backward(Buffer<double>& coefficients, Buffer<double>& sums, int threads) const {
  const ClusterBases& bases = target_bases_;
  const GeneralTree& tree = parts_.targets;
  for (std::size_t level = 0; level < parts_.bases.size(); ++level) {
    const std::vector<std::uint32_t>& clusters = bases.clusters[level];
    const std::size_t rank = parts_.bases[level].rank;
    std::vector<Buffer<double>> transfers;
    for (const RowMatrix& matrix : parts_.bases[level].from_parent) transfers.push_back(padded(matrix));
    parallel_for({clusters.size(), seconds_of(8.0 * static_cast<double>(clusters.size() * rank * rank))}, threads,
                 [&](std::size_t k) {
                   const std::uint32_t number = clusters[k];
                   const GeneralCluster& cluster = tree[number];
                   double* const own = coefficients.data() + bases.first[number];
                   if (number > 0 && tree[cluster.parent].has_basis)
                     add_product(1, parts_.bases[level - 1].rank, rank,
                                 coefficients.data() + bases.first[cluster.parent], transfers[cluster.octant].data(),
                                 own);
                   if (!cluster.leaf) return;
                   // Written by this cluster alone.
                   const double* row = bases.leaf_matrix.data() + bases.leaf_first[cluster.leaf_number];
                   for (std::size_t i = cluster.points.begin; i < cluster.points.end; ++i, row += rank) {
                     double part[4] = {};
                     std::size_t f = 0;
                     for (; f + 4 <= rank; f += 4)
                       for (std::size_t p = 0; p < 4; ++p) part[p] += row[f + p] * own[f + p];
                     for (; f < rank; ++f) part[0] += row[f] * own[f];
                     sums[i] += (part[0] + part[1]) + (part[2] + part[3]);
                   }
                 });
  }
}

void H2Matrix::add_near(const Buffer<double>& charges, Buffer<double>& sums, int threads) const {
  const GeneralTree &targets = parts_.targets, &from = sources();
  const double *target[3] = {}, *source[3] = {};
  for (std::size_t l = 0; l < 3; ++l) {
    target[l] = targets.points()[l].data();
    source[l] = from.points()[l].data();
  }
  for (std::size_t level = 0; level < parts_.blocks.near.size(); ++level) {
    const auto& near = parts_.blocks.near[level];
    const std::vector<std::size_t>& begins = near_targets_[level];
    const std::size_t count = begins.size() - 1;
    // Targets of one level have no points in common.
    parallel_for({count, 1e-9 * kernel_.nanoseconds * parts_.blocks.near_pairs}, threads, [&](std::size_t k) {
      std::vector<Range> runs;
      for (std::size_t i = begins[k]; i < begins[k + 1]; ++i) runs.push_back(from[near[i].source].points);
      std::sort(runs.begin(), runs.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
      std::size_t joined = 0;
      for (std::size_t i = 1; i < runs.size(); ++i) {
        if (runs[i].begin == runs[joined].end)
          runs[joined].end = runs[i].end;
        else
          runs[++joined] = runs[i];
      }
      add_pairs(kernel_, dimension_, target, targets[near[begins[k]].target].points, source, charges.data(),
                runs.data(), joined + 1, sums.data());
    });
  }
  for (const GeneralBlocks::Pair& pair : parts_.blocks.equal) {
    const Range these = targets[pair.target].points, those = from[pair.source].points;
    double sum = 0;
    for (std::size_t j = those.begin; j < those.end; ++j) sum += charges[j];
    double difference[3] = {}, value = 0;
    const double* const rows[3] = {difference, difference + 1, difference + 2};
    for (int l = 0; l < dimension_; ++l) difference[l] = target[l][these.begin] - source[l][those.begin];
    kernel_values(kernel_, dimension_, rows, 1, &value);
    for (std::size_t i = these.begin; i < these.end; ++i) sums[i] += sum * value;
  }
}

void H2Matrix::multiply(const double* charges, double* sums, int threads, GeneralSeconds& seconds) const {
  const std::vector<std::uint32_t>&source_of = sources().original(), &target_of = parts_.targets.original();
  Laps laps;
  Buffer<double> sorted(source_of.size() + padding, 0.0), result(target_of.size() + padding, 0.0);
  for (std::size_t j = 0; j < source_of.size(); ++j) sorted[j] = charges[source_of[j]];
  if (target_bases_.numbers > 0) {
    const Buffer<double> moments = forward(sorted, threads);
    seconds.forward = laps.lap();
    Buffer<double> coefficients(target_bases_.numbers + padding);
    std::fill(coefficients.begin(), coefficients.end(), 0.0);
    couple(moments, coefficients, threads);
    seconds.coupling = laps.lap();
    backward(coefficients, result, threads);
    seconds.backward = laps.lap();
  }
  add_near(sorted, result, threads);
  for (std::size_t i = 0; i < target_of.size(); ++i) sums[target_of[i]] += result[i];
  seconds.near = laps.lap();
}

double H2Matrix::basis_bytes() const {
  double numbers = static_cast<double>(target_bases_.leaf_matrix.size() + source_bases_.leaf_matrix.size());
  for (const LevelBasis& basis : parts_.bases)
    for (const RowMatrix& matrix : basis.to_parent) numbers += static_cast<double>(matrix.size());
  return 8 * numbers;
}

double H2Matrix::coupling_bytes() const {
  double numbers = 0;
  for (const LevelBasis& basis : parts_.bases)
    for (const LevelBasis::Matrix& matrix : basis.matrices) numbers += static_cast<double>(matrix.transposed.size());
  return 8 * numbers;
}

double H2Matrix::list_bytes() const {
  return parts_.blocks.bytes() + parts_.targets.bytes() + (parts_.self ? 0 : parts_.sources.bytes());
}

}  // namespace farfield::detail
