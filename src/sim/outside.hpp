// How much of what is carried is outside the domain, where no density is summed, and what follows from it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/lattice.hpp"
#include "gaussdrift/case.hpp"
#include "particle/particles.hpp"
#include "sim/frame.hpp"

namespace gaussdrift {

/// Part of sum |alpha_j| whose particles are outside; 0 where no weight is left.
double part_outside(const Particles& particles, const Domain& domain);

/// True if so much is outside that the rest is next to nothing: a billionth.
inline bool is_all(double outside) { return outside >= 1 - 1e-9; }

/// True if a density is next to nothing beside the largest at the start: a billionth of it.
inline bool is_nothing(double density, double at_start) { return !(density > 1e-9 * at_start); }

/// Why an output has nothing to compare, one clause for people. weight: sum |alpha_j| there.
std::string why_nothing_is_left(double outside, double weight);

/// "96.1 %", with enough digits that what is missing to 100 % shows; "all" where is_all().
std::string percent_text(double part);

/// What a run has to say about it; empty where less than a thousandth was outside at any output.
std::string about_leaving(const std::vector<std::pair<double, FrameNumbers>>& frames);

/// Part of the mass of rho_0 that lies beyond the domain, so that no particle carries it: where the mass is known and
/// there is density at the edge of the lattice; else 0. `particles` as seeded.
double part_beyond(std::optional<double> mass, const Particles& particles, const Lattice& lattice);

/// What that means for a run; empty where less than a hundredth lies beyond.
std::string about_beyond(double part);

}  // namespace gaussdrift
