// Chooses the method and the parameters r, p, n: of all combinations whose error is proven to keep the tolerance, the
// cheapest by prediction.
#pragma once

#include "fgtd/direct.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/hermite.hpp"

namespace fgtd::detail {

struct Decision {
  Choice choice;        // method, bound, cost, seconds, r, p, n; `boxes` is an estimate
  HermitePlan hermite;  // if the method is hermite
};

/// `sources.position` is read. Throws MemoryLimitError if Method::hermite is asked for and no parameters fit the limit.
template <int d>
Decision choose(const Sources<d>& sources, double sigma, const Options& options);

}  // namespace fgtd::detail
