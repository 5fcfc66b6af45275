// What a choice of method looks at: how many sources and targets there are, how they lie, and what is asked for.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "fgtd/buffer.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

template <int d>
struct Situation {
  const Options& options;
  double sigma;
  double sources;                  // N
  double targets;                  // that are expected
  double columns;                  // of weights, at least 1
  const Buffer<double>& position;  // of all sources, [d][N]
  Buffer<double> sample;           // of some of them, [d][sample_count]
  std::size_t sample_count;
  std::array<double, d> low{}, extent{};                     // the bounding box of the sources
  double to_beat = std::numeric_limits<double>::infinity();  // seconds: a method that cannot be faster need not search
};

template <int d>
Situation<d> look_at(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                     const Options& options);

/// Places occupied by `points` points that fall on equally likely places, of which `sampled` points occupied `seen`.
double extrapolate(double seen, double sampled, double points);

/// Sources within `distance` of a target that lies like the sources, at least 1.
template <int d>
double sources_within(const Situation<d>& at, double distance);

/// Occupied boxes within reach of a target that lies like the sources: no more than there are, than the lattice has
/// there (less at its edges), and than there are sources there.
template <int d>
double boxes_within(const Situation<d>& at, double side, double reach, double occupied);

}  // namespace fgtd::detail
