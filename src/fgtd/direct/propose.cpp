// `direct`, the oracle, as one of the methods. It serves everywhere.
#include <memory>
#include <utility>

#include "fgtd/catalogue.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/direct/sum.hpp"

namespace fgtd::detail {
namespace {

template <int d>
std::optional<Proposal<d>> propose_direct(const Situation<d>& at) {
  Proposal<d> proposal;
  Choice& choice = proposal.choice;
  choice.method = Method::direct;
  choice.bound = 0;
  choice.seconds = at.sources * at.targets * cost::direct_pair[d - 1] * at.columns *
                   (at.options.derivative_order > 0 ? cost::direct_derivative_factor : 1);
  proposal.plan_bytes = 8 * at.sources * (d + at.columns);
  proposal.make = [sigma = at.sigma, threads = at.options.threads](Buffer<double> position) {
    const std::size_t count = position.size() / d;
    return std::make_unique<DirectSum<d>>(std::move(position), count, sigma, threads);
  };
  return proposal;
}

}  // namespace

MethodEntry direct_method() {
  return {.method = Method::direct,
          .name = "direct",
          .meaning = "every pair of a source and a target; for few points",
          .propose = {propose_direct<1>, propose_direct<2>, propose_direct<3>, propose_direct<4>}};
}

}  // namespace fgtd::detail
