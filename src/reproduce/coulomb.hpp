// The table of Boerm's slides again: Coulomb forces of many particles by all pairs, by substitute charges (tree) and by
// symmetric interpolation; time and error.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "farfield/farfield.hpp"

namespace gaussdrift::reproduce {

struct CoulombTime {
  std::optional<double> published_seconds, published_error;
  std::optional<double> published_forward, published_coupling;  // of tree: its seconds in two parts
  std::optional<double> seconds;                                // plan and one evaluation, potential and force
  double setup = 0;                                             // of these, the plan
  farfield::Seconds parts;                                      // and the evaluation
  farfield::Work work;                                          // of one evaluation
  std::optional<double> error;  // of the forces, root of the sum of squares, relative to that of the forces
};

struct CoulombRow {
  std::size_t particles = 0;
  CoulombTime direct, tree, symmetric;
};

struct CoulombReproduction {
  std::vector<CoulombRow> rows;
  std::vector<std::string> disagreements;  // where an error is larger than the published one
  // Exponents p of N^p by symmetric, from an eighth of the last row's particles to these; none without such a row.
  struct Growth {
    double seconds = 0, pairs = 0, couplings = 0;
  };
  std::optional<Growth> growth;
  int threads = 1;
  double seconds = 0;
};

struct CoulombOptions {
  std::size_t most_particles = 400'000;  // --full: 6 400 000
  std::size_t most_by_pairs = 50'000;    // --full: 100 000; more take minutes
  int threads = 1;
};

/// Unit charges at random places of a cube; errors at 500 of the particles against all pairs. The slides do not say
/// which charges, error and machine.
CoulombReproduction reproduce_coulomb(const CoulombOptions& options,
                                      const std::function<void(std::size_t particles)>& progress = {});

std::string to_text(const CoulombReproduction& result);
std::string to_json(const CoulombReproduction& result);

}  // namespace gaussdrift::reproduce
