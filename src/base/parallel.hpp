// Threads: the one place that knows OpenMP. Without OpenMP everything runs on one thread with the same results.
// Work is cut into pieces by the caller, independently of the number of threads, so results never depend on it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <optional>
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

/// Calls body(state, i) for i = 0 .. pieces-1, each exactly once, in any order and on up to `threads` threads (0: all).
/// `state` is what make_state() returns, called once on every thread: scratch memory that pieces use one after the
/// other. The first exception thrown by a piece is rethrown here after all threads have stopped.
template <class MakeState, class Body>
void parallel_for(std::size_t pieces, int threads, const MakeState& make_state, const Body& body) {
#ifdef _OPENMP
  const int used = static_cast<int>(std::min<std::size_t>(pieces, static_cast<std::size_t>(resolve_threads(threads))));
  if (used > 1) {
    std::exception_ptr failure;
    std::atomic<bool> failed{false};
    const auto guarded = [&](const auto& work) {
      if (failed.load(std::memory_order_relaxed)) return;
      try {
        work();
      } catch (...) {
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    };
#pragma omp parallel num_threads(used)
    {
      std::optional<decltype(make_state())> state;
      guarded([&] { state.emplace(make_state()); });
#pragma omp for schedule(dynamic, 1)
      for (std::size_t i = 0; i < pieces; ++i) guarded([&] { body(*state, i); });
    }
    if (failure) std::rethrow_exception(failure);
    return;
  }
#else
  (void)threads;
#endif
  if (pieces == 0) return;
  auto state = make_state();
  for (std::size_t i = 0; i < pieces; ++i) body(state, i);
}

/// The same without a state.
template <class Body>
void parallel_for(std::size_t pieces, int threads, const Body& body) {
  struct Nothing {};
  parallel_for(
      pieces, threads, [] { return Nothing{}; }, [&](Nothing&, std::size_t i) { body(i); });
}

}  // namespace gaussdrift::base
