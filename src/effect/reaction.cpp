#include "effect/reaction.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"

namespace gaussdrift {

void Reaction::settle(Particles& particles, const double* integral, double time) {
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double before = particles.alpha[j];
    if (before == 0) continue;  // stays 0 even where exp() overflows
    const double after = before * std::exp(-integral[j]);
    if (!std::isfinite(after)) {
      std::string place;
      for (int k = 0; k < particles.dimension; ++k)
        place += fmt::format("{}{:.6g}", k ? ", " : "", particles.position[k][j]);
      throw NumericalError(
          fmt::format("reaction has made the weight of particle {} too large for a number by t = {:.6g}, at ({}). The "
                      "weight grew by exp({:.4g}), because the rate of [effects.reaction] is negative there. Bring the "
                      "rate nearer to 0, or shorten time.end.",
                      particles.id[j], time, place, -integral[j]));
    }
    particles.alpha[j] = after;
  }
}

}  // namespace gaussdrift
