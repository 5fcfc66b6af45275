#include "sim/moments.hpp"

#include <algorithm>
#include <cmath>

#include "sim/landings.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

std::vector<double> moments(const Case& spec, const std::vector<double>& landings) {
  std::vector<double> times;
  if (!spec.output.animation) return times;
  const double end = spec.time.end;
  const int frames = spec.output.animation->frames;
  const bool fixed = !time::is_adaptive(time::find_tableau(spec.time.method));
  const double apart = frames > 1 ? end / (frames - 1) : end;
  for (int k = 0; k < frames; ++k) {
    const double wanted = k == frames - 1 ? end : apart * k;
    const auto next = std::lower_bound(landings.begin(), landings.end(), wanted);
    const double after = next == landings.end() ? end : *next, before = next == landings.begin() ? 0 : *(next - 1);
    double time = wanted;
    const time::Interval steps(before, after, spec.time.step);
    if (fixed && spec.time.step <= apart && steps.steps() > 0 && wanted > before)
      time = steps.start(static_cast<std::size_t>(std::lround((wanted - before) / spec.time.step)));
    const double rounding = rounding_of_times(spec);
    if (std::abs(time - before) <= rounding) time = before;
    if (std::abs(time - after) <= rounding) time = after;
    if (times.empty() || time > times.back()) times.push_back(time);
  }
  return times;
}

std::size_t thinning_of_moments(const Lattice& grid) {
  const std::size_t most = grid.dimension == 3 ? 128 : 640;
  const std::size_t longest = std::max({grid.points[0], grid.points[1], grid.points[2]});
  return std::max<std::size_t>(1, (longest - 1 + most - 1) / most);
}

Lattice lattice_of_moments(const Lattice& grid) {
  const std::size_t every = thinning_of_moments(grid);
  Lattice thin = grid;
  thin.spacing = grid.spacing * static_cast<double>(every);
  for (std::size_t k = 0; k < 3; ++k) thin.points[k] = (grid.points[k] - 1) / every + 1;
  return thin;
}

double tolerance_of_moments(const Case& spec) {
  constexpr double enough = 1e-4;  // of the largest value: a colour is 1/256 of the range
  return spec.output.pictures.log ? spec.evaluate.tolerance : std::max(spec.evaluate.tolerance, enough);
}

}  // namespace gaussdrift
