// Points that are hard for a method that replaces clusters, and charges for them.
#pragma once

#include <string>
#include <vector>

#include "farfield/naive.hpp"

namespace clouds {

template <int d>
struct Cloud {
  std::string name;
  farfield::Points<d> points;
};

template <int d>
std::vector<Cloud<d>> all(Eigen::Index count, unsigned seed) {
  using farfield::Points;
  const Points<d> unit = naive::cube<d>(count, seed);
  std::vector<Cloud<d>> clouds{{"cube", unit}, {"plummer", naive::plummer<d>(count, seed)}};
  const auto add = [&](const char* name, const auto& coordinate) {
    Points<d> points(d, count);
    for (Eigen::Index j = 0; j < count; ++j)
      for (int l = 0; l < d; ++l) points(l, j) = coordinate(l, j);
    clouds.push_back({name, points});
  };
  add("collinear", [&](int l, Eigen::Index j) { return (1 + 0.1 * l) * unit(0, j) + 0.3 * l; });
  add("far from the origin", [&](int l, Eigen::Index j) { return 1e6 * (l + 1) + unit(l, j); });
  add("a cluster of 1e-8 beside a cloud of 1",
      [&](int l, Eigen::Index j) { return j % 2 == 0 ? unit(l, j) : -0.3 - 0.1 * l + 1e-8 * unit(l, j); });
  add("a cluster of 1e-8 at the origin beside a cloud of 1",
      [&](int l, Eigen::Index j) { return j % 2 == 0 ? unit(l, j) : 1e-8 * unit(l, j); });
  add("five equal points of each",
      [&](int l, Eigen::Index j) { return unit(l, j % std::max<Eigen::Index>(1, count / 5)); });
  add("two points, each many times", [&](int l, Eigen::Index j) { return 0.3 * static_cast<double>(j % 2) + 0.1 * l; });
  add("lattice", [&](int l, Eigen::Index j) {
    const Eigen::Index side = std::max<Eigen::Index>(2, std::lround(std::pow(static_cast<double>(count), 1.0 / d)));
    Eigen::Index rest = j;
    for (int k = 0; k < l; ++k) rest /= side;
    return static_cast<double>(rest % side) / static_cast<double>(side);
  });
  add("corners of all scales", [&](int l, Eigen::Index j) {
    const double x = unit(l, j), near = 0.5 * std::pow(2 * std::min(x, 1 - x), 8);
    return x < 0.5 ? near : 1 - near;
  });
  // Pairs of clusters with all their points in corners that face each other.
  add("facing corners", [&](int l, Eigen::Index j) {
    const double cell = std::floor(8 * unit(l, j)), inside = 0.01 * (8 * unit(l, j) - cell);
    return (cell + (std::fmod(cell, 4) < 2 ? 0.98 : 0.01) + inside) / 8;
  });
  return clouds;
}

struct Charges {
  std::string name;
  Eigen::VectorXd values;
};

inline std::vector<Charges> charges(Eigen::Index count, unsigned seed) {
  Eigen::VectorXd cancelling = Eigen::VectorXd::Ones(count), one = Eigen::VectorXd::Zero(count);
  for (Eigen::Index j = 0; j < count; j += 2) cancelling[j] = -1;
  if (count > 0) one[static_cast<Eigen::Index>(seed * 7919U) % count] = 1;
  return {{"unit", Eigen::VectorXd::Ones(count)},
          {"random", naive::charges(count, seed)},
          {"cancelling", cancelling},
          {"one", one}};
}

}  // namespace clouds
