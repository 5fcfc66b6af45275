// All that the choice of a method looks at: how many sources and targets there are, how they lie, and what is asked
// for.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

using gaussdrift::core::Buffer;

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

/// Estimates how many places `points` points occupy, if `sampled` of them occupied `seen` and all places are equally
/// likely.
double extrapolate(double seen, double sampled, double points);

/// Sources within `distance` of a target that lies like the sources, at least 1.
template <int d>
double sources_within(const Situation<d>& at, double distance);

/// Occupied boxes within reach of a target that lies like the sources. There are at most as many as in all, as the
/// lattice has there (fewer at its edges), and as there are sources there.
template <int d>
double boxes_within(const Situation<d>& at, double side, double reach, double occupied);

}  // namespace fgtd::detail
