// The exact density by an expression of the case.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gaussdrift/lattice.hpp"
#include "reference/reference.hpp"

namespace gaussdrift {

/// rho as an expression in x, y, (z,) t and the params; `clock` tells the t of a time of the run; empty: they are the same. Throws ExpressionError.
std::unique_ptr<Reference> formula(const std::string& rho, const std::vector<std::pair<std::string, double>>& params,
                                   const Lattice& lattice, std::function<double(double elapsed)> clock = {});

}  // namespace gaussdrift
