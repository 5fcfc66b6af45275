#include "farfield/near/direct.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "farfield/cost.hpp"

namespace farfield::detail {

void Direct::evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const {
  Laps laps;
  constexpr std::size_t piece = 128;  // targets; a source serves all of them while it is in the cache
  const Coordinates& target = problem_.target_points();
  const Range all{0, problem_.sources};
  const double pairs = static_cast<double>(problem_.targets) * static_cast<double>(problem_.sources);
  const gaussdrift::base::Pieces pieces((problem_.targets + piece - 1) / piece,
                                        pairs * pair_seconds(problem_, Precision::full));
  gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t i) {
    PairsJob job{};
    job.interaction = problem_.interaction;
    job.precision = Precision::full;
    for (std::size_t l = 0; l < static_cast<std::size_t>(problem_.dimension()); ++l) {
      job.target[l] = target[l].data();
      job.source[l] = problem_.source[l].data();
      job.field[l] = sums.field[l].data();
    }
    job.targets = {i * piece, std::min(problem_.targets, (i + 1) * piece)};
    job.charge = charges.data();
    job.runs = &all;
    job.run_count = 1;
    job.log_shift = problem_.log_shift;
    job.inverse_squared_core = problem_.inverse_squared_core;
    job.point_beyond = 40;  // exp(-40) = 4e-18
    job.potential = problem_.potential ? sums.potential.data() : nullptr;
    fastest_kernels().pairs(job);
  });
  seconds.leaves = laps.lap();
}

}  // namespace farfield::detail
