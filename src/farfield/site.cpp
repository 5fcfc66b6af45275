#include "farfield/site.hpp"

#include "farfield/near/direct.hpp"

namespace farfield::detail {

template <int d>
double Site<d>::points() const {
  return static_cast<double>(problem_.sources + (problem_.self ? 0 : problem_.targets));
}

template <int d>
std::unique_ptr<Summation> Site<d>::direct() {
  return std::make_unique<Direct>(problem_, options_.threads);
}

template <int d>
Tree<d> Site<d>::tree(std::size_t leaf_size, double smallest_side) {
  return Tree<d>(problem_, leaf_size, smallest_side, options_.threads);
}

template <int d>
std::vector<LevelShare> Site<d>::levels(const Tree<d>& tree) const {
  std::vector<LevelShare> shares;
  for (std::size_t level = 0; level < tree.levels(); ++level) {
    const std::size_t begin = tree.level_begin(level), count = tree.level_begin(level + 1) - begin;
    shares.push_back({begin, count, 0, count});
  }
  return shares;
}

template <int d>
std::unique_ptr<Summation> Site<d>::clustered(typename Clustered<d>::Parts parts, const MethodEntry& method) {
  return std::get<MakeClustered<d>>(method.make)(problem_, std::move(parts));
}

template class Site<2>;
template class Site<3>;

}  // namespace farfield::detail
