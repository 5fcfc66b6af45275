// From the moments of source boxes to numbers at nodes of target boxes or of a grid, an axis at a time. Part of
// fgtd/chebyshev/sum.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/chebyshev/matrices.hpp"
#include "fgtd/chebyshev/sum.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

/// The sums over source boxes and nodes, last axis first, for one column of weights. One object a piece of work.
template <int d>
class ChebyshevSum<d>::Translation {
 public:
  using Group = AxisMatrices::Group;

  Translation(const ChebyshevSum& sum, const Request<d>& request, const std::array<AxisMatrices, d>& matrices)
      : sum_(sum), request_(request), matrices_(matrices) {
    std::vector<std::size_t> all(request.derivatives.size());
    for (std::size_t q = 0; q < all.size(); ++q) all[q] = q;
    subset_[d] = {all};
    input_[d].resize(sum.sources_.box.size());
  }

  void use_column(std::size_t k) {
    for (std::size_t box = 0; box < input_[d].size(); ++box)
      input_[d][box] = sum_.moments_.data() + (box * sum_.columns_ + k) * sum_.box_numbers_;
  }

  /// Contracts axis `axis` of the result of the axes above, for every distinct derivative on it. It calls then(subset
  /// of that order) for each, when its result is in place. `above`: rows of the axes above.
  template <class Then>
  void contract(std::size_t axis, const Group& group, std::size_t above, const std::vector<std::size_t>& derivatives,
                const Then& then) {
    std::vector<std::size_t>& mine = subset_[axis];
    for (int order = 0; order <= request_.highest[axis]; ++order) {
      mine.clear();
      for (const std::size_t q : derivatives)
        if (request_.derivatives[q][axis] == order) mine.push_back(q);
      if (mine.empty()) continue;
      if (contract(axis, group, above, order)) then(mine);
    }
  }

  const std::vector<std::size_t>& all_derivatives() const { return subset_[d]; }
  /// After axis 0: [above][rows], above including all other axes.
  const double* result() const { return output_[0].data(); }

 private:
  /// False if nothing is in reach.
  bool contract(std::size_t axis, const Group& group, std::size_t above, int order) {
    const std::size_t parents = axis == 0 ? 1 : sum_.tree_[axis - 1].index.size();
    const std::size_t size = above * group.rows * to_power(sum_.node_.size(), static_cast<int>(axis));
    std::vector<const double*>& out = input_[axis];
    out.assign(parents, nullptr);
    find_links(axis, group, parents);
    if (place_.empty()) return false;
    if (output_[axis].size() < place_.size() * size + chain_padding)
      output_[axis].resize(place_.size() * size + chain_padding);
    for (std::size_t i = 0; i < place_.size(); ++i) {
      double* to = output_[axis].data() + i * size;
      out[place_[i]] = to;
      sum_links(axis, group, above, order, i, to);
    }
    return true;
  }

  /// Lists the parents that have children within reach of the group, and those children.
  void find_links(std::size_t axis, const Group& group, std::size_t parents) {
    const BoxLevel& children = sum_.tree_[axis];
    const std::vector<const double*>& in = input_[axis + 1];
    place_.clear();
    link_.clear();
    first_link_.assign(1, 0);
    for (std::size_t parent = 0; parent < parents; ++parent) {
      const auto begin = axis == 0 ? 0 : sum_.tree_[axis - 1].first[parent];
      const auto end = axis == 0 ? children.index.size() : sum_.tree_[axis - 1].first[parent + 1];
      const auto from = children.index.begin();
      std::size_t child =
          static_cast<std::size_t>(std::lower_bound(from + static_cast<std::ptrdiff_t>(begin),
                                                    from + static_cast<std::ptrdiff_t>(end), group.low) -
                                   from);
      for (; child < end && children.index[child] <= group.high; ++child)
        if (in[child] != nullptr) link_.push_back(child);
      if (link_.size() == first_link_.back()) continue;
      first_link_.push_back(link_.size());
      place_.push_back(parent);
    }
  }

  /// The sum over the children of parent i of those listed.
  void sum_links(std::size_t axis, const Group& group, std::size_t above, int order, std::size_t i, double* to) {
    const std::size_t p = sum_.node_.size(), width = to_power(p, static_cast<int>(axis));
    const std::size_t* const link = link_.data() + first_link_[i];
    const std::size_t links = first_link_[i + 1] - first_link_[i];
    matrix_.clear();
    for (std::size_t k = 0; k < links; ++k)
      matrix_.push_back(matrices_[axis].matrix(group, sum_.tree_[axis].index[link[k]], order));
    block_.resize(links);
    const std::size_t products = axis == 0 ? 1 : above;
    for (std::size_t q = 0; q < products; ++q) {
      for (std::size_t k = 0; k < links; ++k) block_[k] = input_[axis + 1][link[k]] + q * p * width;
      if (axis == 0) {
        kernels().chain({.rows = above,
                         .depth = p,
                         .width = group.rows,
                         .links = links,
                         .b = block_.data(),
                         .b_stride = p,
                         .d = matrix_.data(),
                         .d_stride = group.rows,
                         .c = to,
                         .c_stride = group.rows,
                         .add = false});
      } else {
        kernels().chain({.rows = group.rows,
                         .depth = p,
                         .width = width,
                         .links = links,
                         .b = matrix_.data(),
                         .b_stride = p,
                         .d = block_.data(),
                         .d_stride = width,
                         .c = to + q * group.rows * width,
                         .c_stride = width,
                         .add = false});
      }
    }
  }

  const ChebyshevSum& sum_;
  const Request<d>& request_;
  const std::array<AxisMatrices, d>& matrices_;
  std::array<std::vector<std::size_t>, d + 1> subset_;   // derivatives that are being computed
  std::array<std::vector<const double*>, d + 1> input_;  // of every node of level axis - 1; null if empty
  std::array<std::vector<double>, d> output_;
  std::vector<std::size_t> place_, link_, first_link_;
  std::vector<const double*> matrix_, block_;
};

}  // namespace fgtd::detail
