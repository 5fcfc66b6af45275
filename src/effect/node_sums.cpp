#include "effect/node_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gaussdrift/error.hpp"

namespace gaussdrift {

NodeSums::NodeSums(int dimension, std::size_t memory_limit, IsOwn is_own)
    : dimension_(dimension), memory_limit_(memory_limit), is_own_(std::move(is_own)) {
  for (int k = 0; k < dimension; ++k) block_size_ *= side;
  if (is_own_) elsewhere_.assign(block_size_, 0.0);
}

void NodeSums::add(const NodeWeights& axes, double weight) {
  const std::size_t nz = dimension_ > 2 ? axes[2].weights.size() : 1, ny = axes[1].weights.size();
  NodeIndex at{};
  for (std::size_t iz = 0; iz < nz; ++iz) {
    if (dimension_ > 2) at[2] = axes[2].first + static_cast<std::int64_t>(iz);
    const double wz = dimension_ > 2 ? weight * axes[2].weights[iz] : weight;
    for (std::size_t iy = 0; iy < ny; ++iy) {
      at[1] = axes[1].first + static_cast<std::int64_t>(iy);
      const double wy = wz * axes[1].weights[iy];
      const std::size_t nx = axes[0].weights.size();
      for (std::size_t ix = 0; ix < nx;) {  // stretches that lie in one block
        at[0] = axes[0].first + static_cast<std::int64_t>(ix);
        double* line = node(at);
        const std::size_t stretch = std::min(nx - ix, static_cast<std::size_t>(side - floor_mod(at[0])));
        for (std::size_t i = 0; i < stretch; ++i) line[i] += wy * axes[0].weights[ix + i];
        ix += stretch;
      }
    }
  }
}

double NodeSums::largest() const {
  double largest = 0;
  for (const Block& block : blocks_)
    for (const double value : block.values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::vector<NodeSums::Line> NodeSums::lines() const {
  std::vector<Line> lines;
  lines.reserve(own_ * block_size_ / side);
  for (const Block& block : blocks_)
    for (std::size_t n = 0; n < block.values.size(); n += side) {
      const auto line = static_cast<std::int64_t>(n) / side;
      NodeIndex first = block.first;
      first[1] += line % side;
      if (dimension_ > 2) first[2] += line / side;
      lines.push_back({first, block.values.data() + n});
    }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
    return std::lexicographical_compare(a.first.rbegin(), a.first.rend(), b.first.rbegin(), b.first.rend());
  });
  return lines;
}

double* NodeSums::node(const NodeIndex& at) {
  NodeIndex first{};
  std::size_t offset = 0;
  for (int k = dimension_ - 1; k >= 0; --k) {
    const std::int64_t inside = floor_mod(at[k]);
    first[k] = at[k] - inside;
    offset = offset * static_cast<std::size_t>(side) + static_cast<std::size_t>(inside);
  }
  if (blocks_.empty() || first != blocks_[last_].first) last_ = find_or_make(first);
  std::vector<double>& values = blocks_[last_].values;
  return (values.empty() ? elsewhere_ : values).data() + offset;
}

std::size_t NodeSums::find_or_make(const NodeIndex& first) {
  std::uint64_t key = 0;
  for (int k = 0; k < dimension_; ++k)
    key = key * 0x200003u + static_cast<std::uint64_t>(first[k] / side + (std::int64_t{1} << 30));
  auto& same_key = by_key_[key];  // the key is a hash: places are compared
  for (const std::size_t index : same_key)
    if (blocks_[index].first == first) return index;
  const bool own = !is_own_ || is_own_(first);
  if (own && ++own_ * (block_size_ * sizeof(double) + 128) > memory_limit_)
    throw NumericalError(fmt::format(
        "remesh would need more than {} GiB for the nodes around the particles, because the particles lie too "
        "scattered. Remesh more often ([effects.remesh] every), lower particles.per_axis, or shorten time.end.",
        memory_limit_ >> 30));
  same_key.push_back(blocks_.size());
  blocks_.push_back({first, std::vector<double>(own ? block_size_ : 0, 0.0)});
  return blocks_.size() - 1;
}

}  // namespace gaussdrift
