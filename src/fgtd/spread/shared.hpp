// One lattice for several Gaussians: sources are spread once, a filter of each Gaussian adds to one result, and targets
// are read once. The lattice is as fine as the narrowest of them needs. Filters of wide ones are long, but act on nodes,
// which are few; where they are not, the Gaussians are not brought together.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fgtd/mixture.hpp"
#include "fgtd/situation.hpp"
#include "fgtd/spread/sum.hpp"

namespace fgtd::detail {

/// Predicted seconds, before any filter is measured. Infinite where a lattice makes no sense. `at.sigma` and
/// `at.options.tolerance` are not looked at.
template <int d>
double shared_seconds(const Situation<d>& at, const std::vector<Gaussian>& gaussians);

template <int d>
struct SharedProposal {
  std::vector<SpreadPart> parts;
  SpreadLayout<d> layout;
  std::vector<Choice> choices;  // of each Gaussian
  double plan_bytes = 0;
};

/// The lattice with the filters, each of them proven to keep the tolerance of its Gaussian. None if there is none.
template <int d>
std::optional<SharedProposal<d>> propose_shared(const Situation<d>& at, const std::vector<Gaussian>& gaussians);

}  // namespace fgtd::detail
