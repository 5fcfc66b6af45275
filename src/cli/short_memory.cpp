#include "cli/short_memory.hpp"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "mpi/ranks.hpp"

namespace gaussdrift::cli {

namespace {

std::terminate_handler usual_end = nullptr;

/// Where nothing may be thrown: destructors of the JSON library allocate, threads do, and so does what is made before main.
[[noreturn]] void end_by_terminate() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    mpi::end_all(static_cast<int>(out_of_memory()));
  } catch (...) {
    usual_end();  // an error in the program: it names it
  }
  std::abort();
}

void prepare() { usual_end = std::set_terminate(end_by_terminate); }

/// The loader calls it before all that the program and its libraries make before main.
[[gnu::section(".preinit_array"), gnu::used]] void (*const at_the_very_start)() = prepare;

}  // namespace

ExitCode out_of_memory() {
  constexpr std::string_view line = "error: out of memory; lower particles.per_axis or evaluate.per_axis\n";
  [[maybe_unused]] const ssize_t lost = ::write(STDERR_FILENO, line.data(), line.size());
  return ExitCode::input;
}

}  // namespace gaussdrift::cli
