// Hermite expansions at scattered targets [Sch06, Algorithm 3.7]. Targets are sorted by box. The targets of one box
// share the list of neighbour boxes and are computed side by side in the lanes of a vector.
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/hermite/hermite.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

/// The occupied boxes with |i - centre| <= n on every axis whose cube is within `reach` (in sides) of the cube
/// `centre`.
template <int d>
class Neighbours {
 public:
  Neighbours(const Boxes<d>& boxes, int n, double reach) : boxes_(boxes), n_(n), squared_reach_(reach * reach) {}

  void find(const BoxIndex<d>& centre, std::vector<std::size_t>& found) const {
    found.clear();
    descend(d - 1, 0, boxes_.level[d - 1].index.size(), centre, 0.0, found);
  }

 private:
  void descend(std::size_t axis, std::size_t begin, std::size_t end, const BoxIndex<d>& centre, double squared,
               std::vector<std::size_t>& found) const {
    const BoxLevel& level = boxes_.level[axis];
    const auto index = level.index.begin();
    std::size_t node = begin;
    if (n_ >= 0) {
      node = static_cast<std::size_t>(std::lower_bound(index + static_cast<std::ptrdiff_t>(begin),
                                                       index + static_cast<std::ptrdiff_t>(end), centre[axis] - n_) -
                                      index);
    }
    for (; node < end; ++node) {
      const std::int64_t apart = level.index[node] - centre[axis];
      if (n_ >= 0 && apart > n_) break;
      const double gap = static_cast<double>(std::max<std::int64_t>(std::abs(apart) - 1, 0));
      const double sum = squared + gap * gap;
      if (sum > squared_reach_) continue;
      if (axis == 0) {
        found.push_back(node);
      } else {
        descend(axis - 1, level.first[node], level.first[node + 1], centre, sum, found);
      }
    }
  }

  const Boxes<d>& boxes_;
  int n_;
  double squared_reach_;
};

/// Up to group_size targets of one box: places begin .. begin+size of the sorted targets.
struct Group {
  std::size_t begin, size;
};

template <int d>
std::vector<Group> make_groups(const std::vector<BoxIndex<d>>& index, const std::vector<std::size_t>& order) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || groups.back().size == group_size || index[order[i]] != index[order[i - 1]]) groups.push_back({i, 0});
    ++groups.back().size;
  }
  return groups;
}

/// The targets of a group by axis, as the kernel reads them: padded by repeating the last one.
template <int d>
void gather(const double* targets, const std::size_t* order, const Group& group, double* target) {
  for (std::size_t i = 0; i < group_size; ++i) {
    const double* from = targets + order[group.begin + std::min(i, group.size - 1)] * d;
    for (std::size_t l = 0; l < d; ++l) target[l * group_size + i] = from[l];
  }
}

/// Adds the derivatives at a group's targets (`out`, [derivative][column][group_size]) to the combinations asked for.
template <int d>
void scatter(const Request<d>& request, std::size_t columns, const double* out, const std::size_t* order,
             const Group& group, std::size_t count, double* values) {
  for (std::size_t q = 0; q < request.combinations.size(); ++q)
    for (const auto& part : request.combinations[q])
      for (std::size_t k = 0; k < columns; ++k) {
        double* column = values + (q * columns + k) * count;
        const double* from = out + (part.derivative * columns + k) * group_size;
        for (std::size_t i = 0; i < group.size; ++i) column[order[group.begin + i]] += part.factor * from[i];
      }
}

}  // namespace

template <int d>
double HermiteSum<d>::point_bytes(const Request<d>& request, std::size_t count) const {
  const double targets = static_cast<double>(count);
  (void)request;
  return targets * (8.0 * d + 8 + 16 + 16 + sizeof(Group));  // indices, places, keys while sorting, groups
}

template <int d>
void HermiteSum<d>::evaluate(const Request<d>& request, const double* targets, std::size_t count,
                             double* values) const {
  const std::size_t derivatives = request.derivatives.size();
  std::fill_n(values, request.combinations.size() * columns_ * count, 0.0);
  if (derivatives == 0 || columns_ == 0 || count == 0 || boxes_.count() == 0) return;

  std::vector<BoxIndex<d>> index(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t l = 0; l < d; ++l) index[i][l] = boxes_.index_at(l, targets[i * d + l]);
  const std::vector<std::size_t> order = sorted_places<d>(index);
  const std::vector<Group> groups = make_groups<d>(index, order);

  const double root_sigma = std::sqrt(sigma_);
  const double scaled_side = boxes_.side * root_sigma;
  const int highest = *std::max_element(request.highest.begin(), request.highest.end());
  const RecurrenceTable recurrence(plan_.terms + highest);
  const std::vector<double> roots = binomial_roots(highest, plan_.terms);
  std::vector<int> alpha;
  for (const auto& derivative : request.derivatives)
    for (std::size_t l = 0; l < max_dimension; ++l) alpha.push_back(l < d ? derivative[l] : 0);
  // The cubes of centres that were rounded are a little off: look a thousandth of a side farther.
  const Neighbours<d> neighbours(boxes_, plan_.neighbours, plan_.reach / scaled_side + 1e-3);

  constexpr std::size_t groups_a_piece = 8;
  const double around = plan_.neighbours < 0 ? HUGE_VAL : std::pow(2 * plan_.neighbours + 1, d);
  const double a_group = std::min(around, static_cast<double>(boxes_.count())) *
                         static_cast<double>(derivatives * columns_ * power(plan_.terms, d) * group_size) *
                         cost::contract_step;
  const gaussdrift::base::Pieces pieces((groups.size() + groups_a_piece - 1) / groups_a_piece,
                                        static_cast<double>(groups.size()) * a_group);
  gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t piece) {
    std::vector<std::size_t> near;
    std::vector<double> scratch(expansion_scratch(d, plan_.terms, highest));
    std::vector<double> out(derivatives * columns_ * group_size);
    double target[d * group_size];
    const std::size_t first = piece * groups_a_piece;
    for (std::size_t g = first; g < std::min(groups.size(), first + groups_a_piece); ++g) {
      const Group group = groups[g];
      const BoxIndex<d>& home = index[order[group.begin]];
      if (g == first || home != index[order[groups[g - 1].begin]]) neighbours.find(home, near);
      if (near.empty()) continue;
      gather<d>(targets, order.data(), group, target);
      std::fill(out.begin(), out.end(), 0.0);
      kernels().expansion({.dimension = d,
                           .terms = plan_.terms,
                           .root_sigma = root_sigma,
                           .half_side = 0.5 * scaled_side,
                           .squared_reach = plan_.reach * plan_.reach,
                           .targets = group.size,
                           .target = target,
                           .boxes = near.size(),
                           .box = near.data(),
                           .centre = boxes_.centre.data(),
                           .moments = moments_.data(),
                           .columns = columns_,
                           .derivatives = derivatives,
                           .order = alpha.data(),
                           .highest = request.highest.data(),
                           .binomial_root = roots.data(),
                           .recurrence = recurrence.view(),
                           .scratch = scratch.data(),
                           .out = out.data()});
      scatter<d>(request, columns_, out.data(), order.data(), group, count, values);
    }
  });
}

#define FGTD_INSTANTIATE(d)                                                         \
  template double HermiteSum<d>::point_bytes(const Request<d>&, std::size_t) const; \
  template void HermiteSum<d>::evaluate(const Request<d>&, const double*, std::size_t, double*) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
