#include "farfield/near/direct.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "farfield/catalogue.hpp"
#include "farfield/cost.hpp"

namespace farfield::detail {

void Direct::evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const {
  Laps laps;
  const Coordinates& target = problem_.target_points();
  const Range all{0, problem_.sources};
  const std::size_t targets = targets_.end - targets_.begin;
  const double pairs = static_cast<double>(targets) * static_cast<double>(problem_.sources);
  const gaussdrift::base::Pieces pieces((targets + piece - 1) / piece, pairs * pair_seconds(problem_, Precision::full));
  gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t i) {
    PairsJob job{};
    job.interaction = problem_.interaction;
    job.precision = Precision::full;
    for (std::size_t l = 0; l < static_cast<std::size_t>(problem_.dimension()); ++l) {
      job.target[l] = target[l].data();
      job.source[l] = problem_.source[l].data();
      job.field[l] = sums.field[l].data();
    }
    const std::size_t begin = targets_.begin + i * piece;
    job.targets = {begin, std::min(targets_.end, begin + piece)};
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

MethodEntry direct_method() {
  return {.method = Method::direct,
          .name = "direct",
          .meaning = "every pair of a source and a target; for few points, and for the highest accuracy"};
}

}  // namespace farfield::detail
