// Threads: the one place that knows OpenMP. Without OpenMP everything runs on one thread with the same results.
// Work is cut into pieces by the caller, independently of the number of threads, so results never depend on it.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace gaussdrift::base {

/// Number of threads to use for `requested`; 0 means all that the machine (or OMP_NUM_THREADS) offers.
inline int resolve_threads(int requested) {
#ifdef _OPENMP
  return requested > 0 ? requested : omp_get_max_threads();
#else
  (void)requested;
  return 1;
#endif
}

/// Calls body(i) for i = 0 .. pieces-1, each exactly once, in any order and on up to `threads` threads (0: all).
/// The first exception thrown by a piece is rethrown here after all threads have stopped.
template <class Body>
void parallel_for(std::size_t pieces, int threads, const Body& body) {
#ifdef _OPENMP
  const int used = resolve_threads(threads);
  if (used > 1 && pieces > 1) {
    std::exception_ptr failure;
    std::atomic<bool> failed{false};
#pragma omp parallel for schedule(dynamic, 1) num_threads(used)
    for (std::size_t i = 0; i < pieces; ++i) {
      if (failed.load(std::memory_order_relaxed)) continue;
      try {
        body(i);
      } catch (...) {
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    }
    if (failure) std::rethrow_exception(failure);
    return;
  }
#else
  (void)threads;
#endif
  for (std::size_t i = 0; i < pieces; ++i) body(i);
}

}  // namespace gaussdrift::base
