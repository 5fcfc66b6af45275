#include "rbf/fit/partition.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace rbf::detail {

using Index = Eigen::Index;

template <int d>
Partition<d>::Partition(const Points<d>& points, Index most) : points_(points) {
  std::vector<Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  bisect(order.begin(), order.end(), most);
}

template <int d>
void Partition<d>::bisect(std::vector<Index>::iterator begin, std::vector<Index>::iterator end, Index most) {
  Part part;
  part.low = part.high = points_.col(*begin);
  for (auto it = begin; it != end; ++it) {
    part.low = part.low.cwiseMin(points_.col(*it));
    part.high = part.high.cwiseMax(points_.col(*it));
  }
  if (end - begin <= most) {
    std::sort(begin, end);
    part.points.assign(begin, end);
    parts_.push_back(std::move(part));
    return;
  }
  Index axis = 0;
  (part.high - part.low).maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](Index a, Index b) {
    return points_(axis, a) != points_(axis, b) ? points_(axis, a) < points_(axis, b) : a < b;
  });
  bisect(begin, middle, most);
  bisect(middle, end, most);
}

template <int d>
std::vector<Index> Partition<d>::neighbourhood(std::size_t i, Index wanted) const {
  const Part& own = parts_[i];
  wanted = std::min(wanted, points_.cols());
  std::vector<std::pair<double, std::size_t>> boxes(parts_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Vector gap = (own.low - parts_[k].high).cwiseMax(parts_[k].low - own.high).cwiseMax(0.0);
    boxes[k] = {gap.squaredNorm(), k};
  }
  std::sort(boxes.begin(), boxes.end());
  // Box by box, until all that is nearer than the next box is enough.
  std::vector<std::pair<double, Index>> found;
  for (std::size_t next = 0; next < boxes.size(); ++next) {
    for (const Index j : parts_[boxes[next].second].points) {
      const Vector gap = (own.low - points_.col(j)).cwiseMax(points_.col(j) - own.high).cwiseMax(0.0);
      found.emplace_back(gap.squaredNorm(), j);
    }
    if (static_cast<Index>(found.size()) < wanted) continue;
    std::nth_element(found.begin(), found.begin() + (wanted - 1), found.end());
    if (next + 1 < boxes.size() && found[static_cast<std::size_t>(wanted - 1)].first > boxes[next + 1].first) continue;
    break;
  }
  std::vector<Index> nearest;
  for (Index k = 0; k < wanted; ++k) nearest.push_back(found[static_cast<std::size_t>(k)].second);
  std::sort(nearest.begin(), nearest.end());
  return nearest;
}

template <int d>
std::vector<Index> Partition<d>::spread(std::size_t i, Index wanted) const {
  const Part& own = parts_[i];
  const Vector middle = own.low + (own.high - own.low) / 2;
  std::vector<double> nearest(own.points.size(), std::numeric_limits<double>::infinity());
  std::vector<Index> found;
  std::size_t next = 0;
  for (std::size_t k = 1; k < own.points.size(); ++k)
    if ((points_.col(own.points[k]) - middle).squaredNorm() < (points_.col(own.points[next]) - middle).squaredNorm())
      next = k;
  while (static_cast<Index>(found.size()) < std::min(wanted, static_cast<Index>(own.points.size()))) {
    found.push_back(own.points[next]);
    for (std::size_t k = 0; k < own.points.size(); ++k)
      nearest[k] = std::min(nearest[k], (points_.col(own.points[k]) - points_.col(found.back())).squaredNorm());
    next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return found;
}

template class Partition<1>;
template class Partition<2>;
template class Partition<3>;

}  // namespace rbf::detail
