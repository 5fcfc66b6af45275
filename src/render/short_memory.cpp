#include "render/short_memory.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <vector>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {

namespace {

// The libraries take 220 MB of address space, and OSMesa with two threads 480 MB, most of them never touched.
constexpr std::size_t room_for_drawing = std::size_t{720} << 20;
constexpr std::size_t next_to_nothing = std::size_t{64} << 20;  // the largest piece that the libraries ask for at once

constexpr std::array signals{SIGSEGV, SIGBUS, SIGABRT};  // LLVM aborts

struct {
  std::mutex mutex;
  int wanted_by = 0;
  std::vector<struct sigaction> before;
} handlers;

/// Async-signal-safe.
bool is_there(std::size_t bytes) {
  void* room = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  munmap(room, bytes);
  return true;
}

/// malloc() has said so just now, to a library that went on without looking; or there is next to nothing left.
bool was_refused_memory(int last_error) { return last_error == ENOMEM || !is_there(next_to_nothing); }

void end_in_order(int signal) {
  if (was_refused_memory(errno)) {
    constexpr char line[] =
        "error: out of memory in the drawing library; allow more (ulimit -v), or draw nothing: output.images = [], "
        "output.report = \"none\"\n";
    if (write(STDERR_FILENO, line, sizeof(line) - 1) < 0) {  // nobody is there to be told
    }
    _exit(static_cast<int>(ExitCode::input));
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

void check_room_for_drawing() {
  if (!is_there(room_for_drawing))
    throw Error(ExitCode::input,
                fmt::format("pictures need {} MB of address space more than this process may have; allow more "
                            "(ulimit -v), or draw nothing: output.images = [], output.report = \"none\"",
                            room_for_drawing >> 20));
}

// Pictures may be drawn by several threads: the first one changes what signals do, and the last one changes it back.
WhileDrawing::WhileDrawing() {
  errno = 0;  // what it says is of this drawing
  const std::lock_guard lock(handlers.mutex);
  if (handlers.wanted_by++ > 0) return;
  struct sigaction action {};
  action.sa_handler = end_in_order;
  sigemptyset(&action.sa_mask);
  for (const int signal : signals) sigaction(signal, &action, &handlers.before.emplace_back());
}

WhileDrawing::~WhileDrawing() {
  const std::lock_guard lock(handlers.mutex);
  if (--handlers.wanted_by > 0) return;
  for (std::size_t k = 0; k < handlers.before.size(); ++k) sigaction(signals[k], &handlers.before[k], nullptr);
  handlers.before.clear();
}

}  // namespace gaussdrift::render
