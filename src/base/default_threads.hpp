// How many threads parallel_for() takes where the caller leaves it open. With parallel.hpp all that knows OpenMP.
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

namespace gaussdrift::base {

/// `threads` at most, from now on, on this thread: what resolve_threads(0) then gives.
inline void limit_default_threads(int threads) {
#ifdef _OPENMP
  if (threads < omp_get_max_threads()) omp_set_num_threads(threads);
#else
  (void)threads;
#endif
}

}  // namespace gaussdrift::base
