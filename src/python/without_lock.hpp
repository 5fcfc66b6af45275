// Long work lets other threads of Python run, and Ctrl-C ends it.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>

#include "base/seam.hpp"

namespace gaussdrift::python {

/// Whether a signal has come whose handler in Python raises something, as that of Ctrl-C does. Python calls handlers on its
/// main thread alone, so elsewhere none comes.
class Signals {
 public:
  /// Made with Python's lock, by the thread that does the work.
  Signals();
  /// Any thread may ask, without the lock. Where it is true, what the handler has raised is set as Python's error.
  bool have_come();

 private:
  std::atomic<bool> come_ = false;
  const unsigned long thread_;  // that made it, if handlers run on it
  const bool handled_here_;
  std::chrono::steady_clock::time_point next_;
};

/// What work() returns. Python's lock is free meanwhile. A signal abandons the work at the next seam, and what its handler
/// raises is thrown.
template <class Work>
auto without_lock(const Work& work) {
  Signals signals;
  const base::AbandonWanted wanted = [&signals] { return signals.have_come(); };
  try {
    const pybind11::gil_scoped_release released;
    const base::Abandonable abandonable(&wanted);
    return work();
  } catch (const base::Abandoned&) {
    throw pybind11::error_already_set();
  }
}

}  // namespace gaussdrift::python
