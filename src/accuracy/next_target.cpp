#include "accuracy/next_target.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/target.hpp"
#include "gaussdrift/error.hpp"
#include "sim/work.hpp"

namespace gaussdrift::accuracy {

std::optional<NextTarget> next_target(const Case& spec, double error, std::size_t particles, double seconds,
                                      int threads) {
  constexpr double least_target = 1e-9;  // beyond it rounding is felt
  constexpr double most_error = 0.1;     // beyond it hardly any search has ended so soon
  constexpr double a_second = 2.5e7;     // of work
  if (!(error > 3 * least_target && error <= most_error)) return std::nullopt;
  const double target = std::pow(10, std::floor(std::log10(error / 3)));
  const Work now = work_of(spec, make_scene(spec, threads), particles);
  try {
    const AccuracyChoice choice = choose_for_accuracy(spec, target, threads, {}, std::min(0.1 * now.total(), a_second));
    const Work then = work_of(choice.spec, make_scene(choice.spec, threads), choice.predicted.particles);
    const double ratio = (then.transport + then.density) / (now.transport + now.density);
    return NextTarget{target, choice.settings, seconds * (ratio - 1)};
  } catch (const InputError&) {  // it cannot be met, or not be found so soon
    return std::nullopt;
  }
}

}  // namespace gaussdrift::accuracy
