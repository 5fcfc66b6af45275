// Points cut into boxes of nearly equal numbers, and what lies around each.
#pragma once

#include <vector>

#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int d>
class Partition {
 public:
  /// Halves of the longest side, again and again, until a part has at most `most` points.
  Partition(const Points<d>& points, Eigen::Index most);

  std::size_t size() const { return parts_.size(); }
  /// The points of a part, ascending.
  const std::vector<Eigen::Index>& part(std::size_t i) const { return parts_[i].points; }
  /// The `wanted` points nearest to the box around a part, its own among them, ascending.
  std::vector<Eigen::Index> neighbourhood(std::size_t i, Eigen::Index wanted) const;
  /// `wanted` points of a part that lie far from each other: each is the farthest from those before. The first is the
  /// nearest to the middle of the box.
  std::vector<Eigen::Index> spread(std::size_t i, Eigen::Index wanted) const;

 private:
  using Vector = Eigen::Matrix<double, d, 1>;
  struct Part {
    std::vector<Eigen::Index> points;
    Vector low, high;
  };
  void bisect(std::vector<Eigen::Index>::iterator begin, std::vector<Eigen::Index>::iterator end, Eigen::Index most);

  const Points<d>& points_;
  std::vector<Part> parts_;
};

/// The coordinates of some points.
template <int d>
Points<d> chosen(const Points<d>& points, const std::vector<Eigen::Index>& which) {
  Points<d> some(d, static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) some.col(static_cast<Eigen::Index>(i)) = points.col(which[i]);
  return some;
}

}  // namespace rbf::detail
