#include "sim/sharing.hpp"

#include <algorithm>

#include "field/velocity/value_seconds.hpp"
#include "sim/landings.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

std::string why_not_shared(const VelocityField& velocity) {
  return velocity.evaluates_in_blocks() ? "" : "this velocity is evaluated at all particles at once";
}

std::function<double(const Tile& tile)> work_of_tiles(const Case& spec, const VelocityField& velocity, double from) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  const std::vector<double> landing = landings(spec);
  const auto next = std::upper_bound(landing.begin(), landing.end(), from);
  const double to = next == landing.end() ? from : *next;
  const double steps =
      time::is_adaptive(tableau) ? 20 : static_cast<double>(time::Interval(from, to, spec.time.step).steps());
  const double carrying = steps * tableau.stages * value_seconds(velocity);
  // Of a particle and a grid point in a Gauss transform.
  const double of_particle = spec.domain.dimension == 2 ? 0.13e-6 : 0.35e-6, of_point = 12e-9;
  return [=](const Tile& tile) {
    const auto particles = static_cast<double>(tile.particles), points = static_cast<double>(tile.size());
    return particles * carrying + tile.sources * of_particle + (tile.sources > 0 ? of_point : 0.1 * of_point) * points;
  };
}

}  // namespace gaussdrift
