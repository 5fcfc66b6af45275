// The exact density at some grid points, and how many of them can be known within some work.
#pragma once

#include <cstddef>
#include <memory>

#include "gaussdrift/case.hpp"
#include "reference/reference.hpp"
#include "sim/comparison.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// By the formula of the case, or traced back along the flow. Traced in any case where density or velocity are fitted to
/// samples: the formula is of what they are samples of, and this is the exact density of the fits.
std::unique_ptr<Reference> exact_density(const Case& spec, const Scene& scene, const Following& following, int threads);

/// Grid points at which the exact density can be known within some work, at most `wanted`.
Affordable points_to_know(const Case& spec, const Scene& scene, std::size_t wanted, double allowed, int threads);

}  // namespace gaussdrift::accuracy
