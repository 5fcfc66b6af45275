#include "fgtd/choose.hpp"

#include <algorithm>
#include <utility>

#include "fgtd/cost.hpp"
#include "fgtd/direct/sum.hpp"

namespace fgtd::detail {

template <int d>
Proposal<d> propose_direct(const Situation<d>& at) {
  Proposal<d> proposal;
  Choice& choice = proposal.choice;
  choice.method = Method::direct;
  choice.bound = 0;
  choice.cost = at.sources * at.targets;
  choice.seconds = choice.cost * cost::direct_pair[d - 1] * at.columns *
                   (at.options.derivative_order > 0 ? cost::direct_derivative_factor : 1);
  proposal.plan_bytes = 8 * at.sources * (d + at.columns);
  proposal.make = [sigma = at.sigma, threads = at.options.threads](Buffer<double> position) {
    const std::size_t count = position.size() / d;
    return std::make_unique<DirectSum<d>>(std::move(position), count, sigma, threads);
  };
  return proposal;
}

template <int d>
Proposal<d> choose(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                   const Options& options) {
  Situation<d> at = look_at<d>(position, count, columns, sigma, options);
  const Method asked = options.hermite ? Method::hermite : options.method;
  Proposal<d> best = propose_direct<d>(at);
  const auto consider = [&](Method method, auto propose) {
    if (count == 0 || (asked != Method::automatic && asked != method)) return;
    if (asked == Method::automatic) at.to_beat = best.choice.seconds;
    std::optional<Proposal<d>> proposal = propose(at);
    if (proposal && (asked == method || proposal->choice.seconds < best.choice.seconds)) best = std::move(*proposal);
  };
  // A search is left out if it takes about as long as it could save.
  const auto worth = [&](Method method, double search) { return asked == method || best.choice.seconds > 2 * search; };
  // The quickest searches come first.
  if (worth(Method::cells, cost::cells_search)) consider(Method::cells, propose_cells<d>);
  if (worth(Method::outer, cost::outer_search)) consider(Method::outer, propose_outer<d>);
  if (worth(Method::spread, cost::spread_search)) consider(Method::spread, propose_spread<d>);
  if (worth(Method::chebyshev, cost::chebyshev_search)) consider(Method::chebyshev, propose_chebyshev<d>);
  if (worth(Method::hermite, cost::hermite_search)) consider(Method::hermite, propose_hermite<d>);

  best.choice.tolerance = options.hermite ? 0 : options.tolerance;
  best.choice.sources = count;
  best.choice.targets = static_cast<std::size_t>(at.targets);
  return best;
}

template Proposal<1> propose_direct<1>(const Situation<1>&);
template Proposal<2> propose_direct<2>(const Situation<2>&);
template Proposal<3> propose_direct<3>(const Situation<3>&);
template Proposal<4> propose_direct<4>(const Situation<4>&);
template Proposal<1> choose<1>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<2> choose<2>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<3> choose<3>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<4> choose<4>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);

}  // namespace fgtd::detail
