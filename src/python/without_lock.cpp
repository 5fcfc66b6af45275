// Signals are looked for twenty times a second.
#include "python/without_lock.hpp"

#include <pythread.h>

namespace gaussdrift::python {

namespace py = pybind11;

Signals::Signals()
    : thread_(PyThread_get_thread_ident()),
      handled_here_(py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>() ==
                    thread_),
      next_(std::chrono::steady_clock::now()) {}

bool Signals::have_come() {
  if (come_.load(std::memory_order_relaxed)) return true;
  if (!handled_here_ || PyThread_get_thread_ident() != thread_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + std::chrono::milliseconds(50);
  const PyGILState_STATE lock = PyGILState_Ensure();
  const bool come = PyErr_CheckSignals() != 0;
  PyGILState_Release(lock);
  if (come) come_.store(true, std::memory_order_relaxed);
  return come;
}

}  // namespace gaussdrift::python
