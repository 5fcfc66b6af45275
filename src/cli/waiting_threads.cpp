#include "cli/waiting_threads.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

namespace gaussdrift::cli {

namespace {

constexpr std::size_t most_threads = 1024;

/// How many threads the run may want: all of the machine, or what --threads says.
std::size_t wanted_threads(char** argv) {
  long most = std::max(1L, sysconf(_SC_NPROCESSORS_ONLN));
  for (char** word = argv; *word; ++word) {
    const std::string_view text = *word;
    if (text == "--threads" && word[1]) most = std::max(most, std::strtol(word[1], nullptr, 10));
    if (text.starts_with("--threads=")) most = std::max(most, std::strtol(*word + 10, nullptr, 10));
  }
  return static_cast<std::size_t>(std::min(most, static_cast<long>(most_threads)));
}

/// How many of them can be had, this one among them. They live at the same time.
std::size_t threads_to_be_had(std::size_t wanted) {
  pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&gate);
  std::array<pthread_t, most_threads> started;
  std::size_t count = 0;
  const auto wait = [](void* at) -> void* {
    pthread_mutex_lock(static_cast<pthread_mutex_t*>(at));
    pthread_mutex_unlock(static_cast<pthread_mutex_t*>(at));
    return nullptr;
  };
  while (count + 1 < wanted && pthread_create(&started[count], nullptr, wait, &gate) == 0) ++count;
  pthread_mutex_unlock(&gate);
  for (std::size_t k = 0; k < count; ++k) pthread_join(started[k], nullptr);
  return count + 1;
}

/// Whether something had to be said that nobody has said yet.
bool say_how_threads_wait(char** argv) {
  bool changed = false;
  if (!std::getenv("OMP_WAIT_POLICY") && !std::getenv("GOMP_SPINCOUNT"))
    changed = setenv("OMP_WAIT_POLICY", "passive", 1) == 0;
  if (!std::getenv("OMP_THREAD_LIMIT"))
    if (const std::size_t wanted = wanted_threads(argv), found = threads_to_be_had(wanted); found < wanted)
      changed = setenv("OMP_THREAD_LIMIT", std::to_string(found).c_str(), 1) == 0 || changed;
  return changed;
}

#ifdef GAUSSDRIFT_OPENMP_IS_OURS
/// The run-time library is a part of the program, whose parts begin in the order of these numbers; that library has none, so it
/// begins later.
[[gnu::constructor(101)]] void before_the_library_looks(int, char** argv, char**) { say_how_threads_wait(argv); }
#endif

}  // namespace

void prepare_threads([[maybe_unused]] char** argv) {
#ifndef GAUSSDRIFT_OPENMP_IS_OURS
  if (say_how_threads_wait(argv)) execv("/proc/self/exe", argv);
#endif
}

}  // namespace gaussdrift::cli
