#include "accuracy/known_density.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/causes.hpp"

namespace gaussdrift::accuracy {

namespace {

/// The case with a reference that is traced back along the flow.
Case traced(Case spec) {
  spec.reference = {};
  spec.reference.kind = ReferenceSpec::Kind::characteristics;
  return spec;
}

bool has_formula(const Case& spec, const Scene& scene) {
  return spec.reference.kind == ReferenceSpec::Kind::exact && !is_fitted(scene);
}

}  // namespace

std::unique_ptr<Reference> exact_density(const Case& spec, const Scene& scene, const Following& following,
                                         int threads) {
  if (has_formula(spec, scene)) return make_reference(spec, scene, threads);
  return make_reference(traced(spec), scene, threads, following);
}

Affordable points_to_know(const Case& spec, const Scene& scene, std::size_t wanted, double allowed, int threads) {
  if (has_formula(spec, scene)) return {.points = wanted};
  const bool whatever = std::isinf(allowed);
  if (whatever) allowed = 2e7;  // a second: a few paths that stick to a jump would take longer than all others
  Affordable known = affordable_paths(traced(spec), scene, allowed, 1, threads);
  if (whatever && known.points == 0) return {.points = wanted};
  known.points = std::min(known.points, wanted);
  return known;
}

}  // namespace gaussdrift::accuracy
