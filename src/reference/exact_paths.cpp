#include "reference/exact_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.hpp"
#include "field/velocity/value_seconds.hpp"
#include "time/adaptive.hpp"

namespace gaussdrift {

ExactPaths carry_exactly(const VelocityField& velocity, const ScalarField* rate, Particles& particles, double from,
                         double to, const ExactPathsOptions& options) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  const std::size_t components = dimension + (rate ? 1 : 0);
  // A field with kinks asks for short steps at each; particles that share steps would all take them.
  const std::size_t longest = velocity.is_smooth() && (!rate || rate->is_smooth()) ? 128 : 1;
  const std::size_t blocks = (particles.size() + longest - 1) / longest;
  time::AdaptiveOptions bounds;
  bounds.most_steps = options.most_steps;
  bounds.longest_step = std::abs(to - from) / 8;
  bounds.components.assign(
      dimension, {options.tolerance * options.length, 4 * std::numeric_limits<double>::epsilon(), options.length / 4});
  if (rate) bounds.components.push_back({options.tolerance, options.tolerance, 0});
  std::vector<ExactPaths> done(blocks);
  constexpr std::size_t stages = 12;
  const double steps = 30;  // roughly, of one block
  const base::Pieces pieces(blocks, static_cast<double>(particles.size() * stages) * steps * value_seconds(velocity));
  base::parallel_for(pieces, options.threads, [&](std::size_t b) {
    const std::size_t begin = b * longest, count = std::min(longest, particles.size() - begin);
    std::vector<double> state(components * count, 0.0);
    for (std::size_t k = 0; k < dimension; ++k)
      std::copy_n(particles.position[k].data() + begin, count, state.data() + k * count);
    const auto derivative = [&](double t, const double* y, double* dy) {
      std::fill_n(dy, components * count, 0.0);
      PointsView x{particles.dimension, count, {}};
      VectorsView u{particles.dimension, count, {}};
      for (std::size_t k = 0; k < dimension; ++k) x.axis[k] = y + k * count, u.axis[k] = dy + k * count;
      velocity.add(t, x, u);
      if (rate) rate->add(t, x, dy + dimension * count);
    };
    const auto result = time::integrate_adaptively(derivative, from, to, count, bounds, state.data());
    if (!result.reached) {
      std::fill(state.begin(), state.end(), std::numeric_limits<double>::quiet_NaN());
      done[b].lost = count;
    }
    done[b].rates = stages * count * (result.steps + result.rejected);
    for (std::size_t k = 0; k < dimension; ++k)
      std::copy_n(state.data() + k * count, count, particles.position[k].data() + begin);
    if (rate)
      for (std::size_t i = 0; i < count; ++i) particles.alpha[begin + i] *= std::exp(-state[dimension * count + i]);
  });
  ExactPaths all;
  for (const ExactPaths& block : done) all.lost += block.lost, all.rates += block.rates;
  return all;
}

}  // namespace gaussdrift
