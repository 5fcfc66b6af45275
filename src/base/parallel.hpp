// Threads: the one place that knows OpenMP. Without OpenMP everything runs on one thread with the same results.
// Work is cut into pieces by the caller, independently of the number of threads, so results never depend on it.
// Small work stays on the thread that brings it: others have to be woken, and on a busy machine they come late.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <optional>

#include "base/seam.hpp"

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

/// How many pieces there are, and what all of them take on one thread. Roughly: three times too much or too little is
/// good enough. Where pieces are few and long an estimate that is far too low costs the time of one piece.
struct Pieces {
  Pieces(std::size_t pieces, double all_seconds) : count(pieces), seconds(all_seconds) {}
  std::size_t count;
  double seconds;
};

namespace detail {

inline std::atomic<double> least_shared{1e-4};  // ten times what it takes to wake a thread that sleeps
inline std::atomic<std::size_t> regions{0};

}  // namespace detail

/// Sets the seconds of work from which on it is shared among threads and returns those before. 0: all is shared, as
/// tests of threads want it.
inline double share_from(double seconds) { return detail::least_shared.exchange(seconds); }

/// How often work has been shared among threads so far.
inline std::size_t regions_opened() { return detail::regions.load(); }

/// Calls body(state, i) for i = 0 .. pieces-1, each exactly once, in any order and on up to `threads` threads (0: all).
/// `state` is what make_state() returns, called once on every thread that does pieces: scratch memory that pieces use
/// one after the other. The first exception thrown by a piece is rethrown here after all threads have stopped.
///
/// Work of less than 100 microseconds runs on the calling thread. It is timed, and what is left goes to all threads if
/// it turns out to be longer.
///
/// Before each piece is a seam: work that is abandoned there (base/seam.hpp) ends with Abandoned.
template <class MakeState, class Body>
void parallel_for(const Pieces& pieces, int threads, const MakeState& make_state, const Body& body) {
  if (pieces.count == 0) return;
  std::optional<decltype(make_state())> own;  // of the calling thread
  const std::size_t most =
      std::min<std::size_t>(pieces.count, static_cast<std::size_t>(std::max(1, resolve_threads(threads))));
  const double least = detail::least_shared.load(std::memory_order_relaxed);
  bool shared = most > 1 && (least <= 0 || pieces.seconds >= least);
  std::size_t done = 0;
  if (!shared) {
    using Clock = std::chrono::steady_clock;
    const std::size_t looks = most > 1 ? 64 : 1, between = (pieces.count + looks - 1) / looks;
    own.emplace(make_state());
    const Clock::time_point begun = Clock::now();
    while (done < pieces.count && !shared) {
      for (const std::size_t end = std::min(pieces.count, done + between); done < end; ++done) {
        seam();
        body(*own, done);
      }
      const std::size_t left = pieces.count - done;
      if (most == 1 || left < 2) continue;
      const double spent = std::chrono::duration<double>(Clock::now() - begun).count();
      // Not by the very first pieces, which find nothing in the cache.
      shared = spent >= 0.1 * least && spent * static_cast<double>(left) >= least * static_cast<double>(done);
    }
    if (!shared) return;
  }
#ifdef _OPENMP
  ++detail::regions;
  std::exception_ptr failure;
  std::atomic<bool> failed{false};
  const int used = static_cast<int>(std::min(most, pieces.count - done));
  const AbandonWanted* const wanted = detail::abandon_wanted;
#pragma omp parallel num_threads(used)
  {
    const Abandonable as_its_caller(wanted);
    std::optional<decltype(make_state())> another;
    auto& state = omp_get_thread_num() == 0 ? own : another;  // the calling thread is number 0
#pragma omp for schedule(dynamic, 1)
    for (std::size_t i = done; i < pieces.count; ++i) {
      if (failed.load(std::memory_order_relaxed)) continue;
      try {
        seam();
        if (!state) state.emplace(make_state());
        body(*state, i);
      } catch (...) {
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
#endif
}

/// The same without a state.
template <class Body>
void parallel_for(const Pieces& pieces, int threads, const Body& body) {
  struct Nothing {};
  parallel_for(
      pieces, threads, [] { return Nothing{}; }, [&](Nothing&, std::size_t i) { body(i); });
}

}  // namespace gaussdrift::base
