#include "fgtd/choose.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "fgtd/catalogue.hpp"

namespace fgtd::detail {
namespace {

/// The quickest searches come first, so that long ones are left out where a quick one has found something fast.
std::vector<const MethodEntry*> by_search() {
  std::vector<const MethodEntry*> entries;
  for (const MethodEntry& entry : catalogue()) entries.push_back(&entry);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const MethodEntry* a, const MethodEntry* b) { return a->search_seconds < b->search_seconds; });
  return entries;
}

}  // namespace

template <int d>
Proposal<d> choose(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                   const Options& options) {
  Situation<d> at = look_at<d>(position, count, columns, sigma, options);
  const Method asked = options.hermite ? Method::hermite : options.method;
  const auto propose = [&](const MethodEntry& entry) { return std::get<d - 1>(entry.propose)(at); };
  Proposal<d> best = *propose(*find_entry(Method::direct));
  for (const MethodEntry* entry : by_search()) {
    const bool wanted = asked == entry->method, any = asked == Method::automatic;
    if (count == 0 || entry->method == Method::direct || !(wanted || any)) continue;
    // A search is left out if it takes about as long as it could save.
    if (any && best.choice.seconds <= 2 * entry->search_seconds) continue;
    if (any) at.to_beat = best.choice.seconds;
    std::optional<Proposal<d>> proposal = propose(*entry);
    if (!proposal || !(wanted || proposal->choice.seconds < best.choice.seconds)) continue;
    best = std::move(*proposal);
    best.choice.method = entry->method;
  }
  best.choice.tolerance = options.hermite ? 0 : options.tolerance;
  best.choice.sources = count;
  best.choice.targets = static_cast<std::size_t>(at.targets);
  return best;
}

template Proposal<1> choose<1>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<2> choose<2>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<3> choose<3>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);
template Proposal<4> choose<4>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&);

}  // namespace fgtd::detail
