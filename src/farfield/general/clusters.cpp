#include "farfield/general/clusters.hpp"

#include <algorithm>
#include <map>

#include "farfield/check.hpp"

namespace farfield::detail {

GeneralTree::GeneralTree(int dimension, Coordinates points, std::size_t count, const std::array<double, 3>& corner,
                         double side)
    : dimension_(dimension), corner_(corner), side_(side), points_(std::move(points)), original_(count) {
  for (std::size_t i = 0; i < count; ++i) original_[i] = static_cast<std::uint32_t>(i);
  GeneralCluster root;
  root.points = {0, count};
  clusters_.push_back(root);
}

namespace {

bool all_equal(const Coordinates& points, Range range, int dimension) {
  for (int l = 0; l < dimension; ++l) {
    const auto& x = points[static_cast<std::size_t>(l)];
    for (std::size_t i = range.begin + 1; i < range.end; ++i)
      if (x[i] != x[range.begin]) return false;
  }
  return true;
}

}  // namespace

void GeneralTree::divide(std::uint32_t number) {
  if (clusters_[number].children > 0) return;
  const GeneralCluster cluster = clusters_[number];
  const auto axes = static_cast<std::size_t>(dimension_);
  double middle[3];
  for (int l = 0; l < dimension_; ++l) middle[l] = centre(cluster, l);
  const auto octant_of = [&](std::size_t i) {
    unsigned octant = 0;
    for (std::size_t l = 0; l < axes; ++l) octant |= points_[l][i] >= middle[l] ? 1U << l : 0U;
    return octant;
  };
  std::size_t end[8] = {};
  std::vector<std::uint8_t> octants(cluster.size());
  for (std::size_t i = cluster.points.begin; i < cluster.points.end; ++i)
    ++end[octants[i - cluster.points.begin] = static_cast<std::uint8_t>(octant_of(i))];
  std::size_t place[8], sum = 0;
  for (int o = 0; o < 8; ++o) {
    place[o] = sum;
    end[o] = sum += end[o];
  }
  // Points of one octant stay in their order.
  std::vector<std::size_t> from(cluster.size());
  for (std::size_t i = 0; i < from.size(); ++i) from[place[octants[i]]++] = cluster.points.begin + i;
  const auto reorder = [&](auto& values) {
    std::vector<typename std::decay_t<decltype(values)>::value_type> sorted(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) sorted[i] = values[from[i]];
    std::copy(sorted.begin(), sorted.end(), values.begin() + static_cast<std::ptrdiff_t>(cluster.points.begin));
  };
  for (std::size_t l = 0; l < axes; ++l) reorder(points_[l]);
  reorder(original_);
  const auto first = static_cast<std::uint32_t>(clusters_.size());
  for (unsigned o = 0; o < 1U << dimension_; ++o) {
    const std::size_t begin = o == 0 ? 0 : end[o - 1];
    if (begin == end[o]) continue;
    GeneralCluster child;
    child.level = cluster.level + 1;
    child.parent = number;
    child.octant = static_cast<std::uint8_t>(o);
    for (std::size_t l = 0; l < axes; ++l) child.cell[l] = 2 * cluster.cell[l] + (o >> l & 1U);
    child.points = {cluster.points.begin + begin, cluster.points.begin + end[o]};
    child.one_point = cluster.one_point || all_equal(points_, child.points, dimension_);
    clusters_.push_back(child);
  }
  clusters_[number].first_child = first;
  clusters_[number].children = static_cast<std::uint8_t>(clusters_.size() - first);
}

double GeneralTree::bytes() const {
  return static_cast<double>(clusters_.size() * sizeof(GeneralCluster)) +
         static_cast<double>(original_.size()) * (4 + 8 * dimension_);
}

double GeneralBlocks::bytes() const {
  double sum = static_cast<double>(equal.size() * sizeof(Pair));
  for (const auto& level : couplings) sum += static_cast<double>(level.size() * sizeof(GeneralCoupling));
  for (const auto& level : near) sum += static_cast<double>(level.size() * sizeof(Pair));
  return sum;
}

namespace {

/// Sorts a level's couplings by target and numbers its offsets in their order.
void number_offsets(std::vector<GeneralCoupling>& couplings, const GeneralTree& targets, const GeneralTree& sources,
                    std::vector<GeneralOffset>& offsets) {
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto offset_of = [&](const GeneralCoupling& coupling) {
    std::array<int, 3> offset{};
    for (std::size_t l = 0; l < 3; ++l)
      offset[l] = static_cast<int>(targets[coupling.target].cell[l] - sources[coupling.source].cell[l]);
    return offset;
  };
  for (const GeneralCoupling& coupling : couplings) known.try_emplace(offset_of(coupling), 0);
  for (auto& [offset, number] : known) {
    number = static_cast<std::uint32_t>(offsets.size());
    offsets.push_back({offset, 0});
  }
  for (GeneralCoupling& coupling : couplings) {
    coupling.offset = known.at(offset_of(coupling));
    offsets[coupling.offset].far_pairs +=
        static_cast<double>(targets[coupling.target].size()) * static_cast<double>(sources[coupling.source].size());
  }
  std::sort(couplings.begin(), couplings.end(), [](const GeneralCoupling& a, const GeneralCoupling& b) {
    return a.target != b.target ? a.target < b.target : a.source < b.source;
  });
}

}  // namespace

GeneralBlocks make_blocks(GeneralTree& targets, GeneralTree& sources, const DivisionLimits& limits,
                          std::size_t memory_limit) {
  GeneralBlocks blocks;
  std::vector<GeneralBlocks::Pair> open{{0, 0}};
  const auto pairs_of = [&](const GeneralBlocks::Pair& pair) {
    return static_cast<double>(targets[pair.target].size()) * static_cast<double>(sources[pair.source].size());
  };
  for (int level = 0; !open.empty(); ++level) {
    std::vector<GeneralBlocks::Pair> next;
    auto& couplings = blocks.couplings.emplace_back();
    auto& near = blocks.near.emplace_back();
    blocks.offsets.emplace_back();
    const auto close = [&](const GeneralBlocks::Pair& pair) {
      near.push_back(pair);
      blocks.near_pairs += pairs_of(pair);
    };
    for (const GeneralBlocks::Pair& pair : open) {
      const GeneralCluster& target = targets[pair.target];
      const GeneralCluster& source = sources[pair.source];
      std::int64_t apart = 0;
      for (std::size_t l = 0; l < 3; ++l) apart = std::max(apart, std::abs(target.cell[l] - source.cell[l]));
      const double count = pairs_of(pair);
      if (count < limits.worthwhile) {
        close(pair);
      } else if (target.one_point && source.one_point) {
        blocks.equal.push_back(pair);
      } else if (apart > limits.separation) {
        couplings.push_back({pair.target, pair.source, 0});
      } else if (count < limits.touching || level == GeneralCluster::deepest) {
        close(pair);
      } else {
        targets.divide(pair.target);
        sources.divide(pair.source);
        const GeneralCluster &t = targets[pair.target], &s = sources[pair.source];
        for (std::uint32_t a = 0; a < t.children; ++a)
          for (std::uint32_t b = 0; b < s.children; ++b) next.push_back({t.first_child + a, s.first_child + b});
      }
    }
    check_memory("lists of blocks",
                 blocks.bytes() + targets.bytes() + sources.bytes() +
                     static_cast<double>(next.size() * sizeof(GeneralBlocks::Pair)),
                 memory_limit);
    number_offsets(couplings, targets, sources, blocks.offsets.back());
    std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
      return a.target != b.target ? a.target < b.target : a.source < b.source;
    });
    open = std::move(next);
  }
  return blocks;
}

std::size_t mark_bases(GeneralTree& tree, const std::vector<std::uint32_t>& coupled) {
  std::vector<char> is_coupled(tree.size(), 0), below(tree.size(), 0);  // below: it or a descendant is coupled
  for (const std::uint32_t number : coupled) is_coupled[number] = below[number] = 1;
  // Children have higher numbers than their parents.
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.size()); i-- > 1;)
    if (below[i] != 0) below[tree[i].parent] = 1;
  std::size_t leaves = 0;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    GeneralCluster& cluster = tree[i];
    const bool inside = i > 0 && tree[cluster.parent].has_basis && !tree[cluster.parent].leaf;
    cluster.has_basis = is_coupled[i] != 0 || inside;
    if (!cluster.has_basis) continue;
    bool divided = false;
    for (std::uint32_t c = 0; c < cluster.children; ++c) divided |= below[cluster.first_child + c] != 0;
    cluster.leaf = !divided;
    if (cluster.leaf) cluster.leaf_number = leaves++;
  }
  return leaves;
}

}  // namespace farfield::detail
