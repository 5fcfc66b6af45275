// The point sets of [Sch06, 4.1.5 and 4.7] in the unit cube.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fgtd/fgtd.hpp"

namespace gaussdrift::reproduce {

/// Halton number n to a prime base, Algorithm 4.1 of [Sch06]; number 0 is 0.
double halton(std::size_t n, int base);

/// The first prime bases; points in d dimensions take the first d, their weights the next.
constexpr int primes[] = {2, 3, 5, 7, 11};

/// Halton points 0 .. count-1, the first one being the origin: with it the numbers of Table 4.8 come out to all digits.
template <int d>
fgtd::Points<d> halton_points(std::size_t count);

/// Halton numbers 0 .. count-1 to base primes[d].
Eigen::MatrixXd halton_weights(std::size_t count, int d);

/// Independent and uniform, the same for a seed on every machine.
template <int d>
fgtd::Points<d> random_points(std::size_t count, std::uint64_t seed);

/// Uniform in cubes of the given side, one after the other; the cubes lie in the unit cube at random.
template <int d>
fgtd::Points<d> clustered_points(std::size_t count, std::size_t clusters, double side, std::uint64_t seed);

/// i * spacing, i = 0 .. per_axis-1 on every axis, first axis fastest.
template <int d>
fgtd::Points<d> grid_points(std::size_t per_axis, double spacing);

}  // namespace gaussdrift::reproduce
