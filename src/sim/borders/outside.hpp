// How much of the density has left the domain, where it is not summed, and the warnings about it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Part of sum |alpha_j| whose particles are outside; 0 where no weight is left.
double part_outside(const Particles& particles, const Domain& domain);

/// True if less than a billionth is inside.
inline bool is_all(double outside) { return outside >= 1 - 1e-9; }

/// True if a density is less than a billionth of the largest at the start.
inline bool is_nothing(double density, double at_start) { return !(density > 1e-9 * at_start); }

/// True if some particle has left the run by an open edge or another way out.
bool has_left(const FrameNumbers& numbers);

/// Why an output has nothing to compare, one clause for people. weight: sum |alpha_j| there.
std::string why_nothing_is_left(double outside, double weight);

/// "96.1 %", with enough digits that what is missing to 100 % shows; "all" where is_all().
std::string percent_text(double part);

/// The warning about it; empty if less than a thousandth was outside at every output.
std::string about_leaving(const std::vector<std::pair<double, FrameNumbers>>& frames);

/// The part of the mass of rho_0 that lies outside the domain, so that no particle carries it. 0 if the mass is not
/// known, or if there is no density at the edge of the lattice. `particles` as seeded.
double part_beyond(std::optional<double> mass, const Particles& particles, const Lattice& lattice);

/// The largest |weight| of some particles, and of those that started at the edge of the lattice.
struct Heaviest {
  double anywhere = 0, at_edge = 0;
};
Heaviest heaviest(const Particles& particles, const Lattice& lattice);

/// The same from what is known of the particles: `carried` is the sum of their weights.
double part_beyond(std::optional<double> mass, const Heaviest& heaviest, double carried);

/// The particle is outside the domain, by more than rounding.
bool is_outside(const Particles& particles, std::size_t j, const Domain& domain);

/// The warning about that; empty if less than a hundredth lies outside.
std::string about_beyond(double part);

}  // namespace gaussdrift
