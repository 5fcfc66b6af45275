// Grid points at which the causes of an error are told apart, and the sums of blobs at them.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift::accuracy {

struct Probe {
  std::size_t index = 0;  // on the evaluation lattice
  Vector x{};
  double exact = 0;
};

/// The point of that number.
Vector grid_point(const Lattice& lattice, std::size_t index);

/// Grid points with large errors, not beside each other, and the one of the largest density. `rho` and `exact` are the
/// densities at `points`. No two probes are closer than `apart`, and there are at most `most`.
std::vector<Probe> choose_probes(const Lattice& lattice, const std::vector<std::size_t>& points,
                                 const std::vector<double>& rho, const std::vector<double>& exact, double apart,
                                 std::size_t most);

std::vector<double> exact_of(const std::vector<Probe>& probes);

/// The sum of all blobs at each probe, and of their images beyond edges of the domain.
std::vector<double> sums_at(const std::vector<Probe>& probes, const Particles& particles, const Cutoff& cutoff,
                            const Domain& domain, int threads);

/// Beyond `widths` of the widest Gaussian nothing is summed: 5 leave 1e-11 of a blob's height, 6 leave 1e-15.
double reach_of(const Cutoff& cutoff, double widths);

/// The particles within reach of a probe, or with an image within reach of one, as numbers in ascending order.
std::vector<std::size_t> near(const std::vector<Probe>& probes, const Particles& particles, double reach,
                              const Domain& domain);

/// NaN if some difference is NaN.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace gaussdrift::accuracy
