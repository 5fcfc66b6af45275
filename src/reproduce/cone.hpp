// Tables 5.1 and 5.2 of [Sch06] again: heights of the rotating cone over lattice, overlap and time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift::reproduce {

/// The cone at t = 0: Wendland's function of radius 1/4 at (1/2, 0), on a lattice over [-1, 1]^2 [Sch06, 5.3.2].
struct Cone {
  Lattice seeding;
  Particles particles;
};
Cone seed_cone(int per_axis, int threads);

struct ConeHeight {
  int table = 51;    // 51: Table 5.1, 52: Table 5.2
  int per_axis = 0;  // n_g
  int overlap = 0;   // c
  std::string time;  // as printed: "0", "2 pi", "20 pi"
  double published = 0;
  double computed = 0;  // maximum of rho on the 700 x 700 grid
};

struct ConeReproduction {
  std::vector<ConeHeight> heights;
  double worst_difference = 0;  // of computed and published
  double seconds = 0;
};

/// The printed digits round at 5e-7; agreement is a difference of at most this.
constexpr double cone_agreement = 6e-7;

/// Follows the paper: n_ge = 700, tau = 0.001, floor(t / tau) full steps. `progress` is told done and total heights.
ConeReproduction reproduce_cone(int threads, const std::function<void(std::size_t, std::size_t)>& progress = {});

std::string to_text(const ConeReproduction& result);
std::string to_json(const ConeReproduction& result);

}  // namespace gaussdrift::reproduce
