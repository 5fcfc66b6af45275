// Which steps are stable: the stability function R(z) of an explicit Runge-Kutta method, computed from its tableau.
// On y' = lambda y a step multiplies y by R(lambda dt). method.md, section 4.
#pragma once

#include <complex>
#include <vector>

#include "time/tableau.hpp"

namespace gaussdrift::time {

/// R(z) = 1 + z b^T 1 + z^2 b^T A 1 + ... as its coefficients, lowest power first.
std::vector<double> stability_polynomial(const Tableau& rk);

std::complex<double> stability_function(const std::vector<double>& polynomial, std::complex<double> z);

/// Logarithm of the factor by which a motion of rate lambda, y' = lambda y, grows too much over the time `length` in
/// steps of `step`: (length / step) (ln |R(lambda step)| - max(0, Re lambda) step).
double growth_of_step(const Tableau& rk, std::complex<double> lambda, double length, double step);

/// The largest step <= `most` up to which that logarithm stays below `growth` > 0. `most` may be infinite.
double largest_stable_step(const Tableau& rk, std::complex<double> lambda, double length, double growth, double most);

}  // namespace gaussdrift::time
