#include "cli/ending.hpp"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <span>

#include "cli/short_memory.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/read_case.hpp"
#include "mpi/ranks.hpp"

namespace gaussdrift::cli {

namespace {

constexpr int exit_code(ExitCode code) { return static_cast<int>(code); }

/// Tells an error, if aloud, after the words `who`; the code to end with.
ExitCode tell(const std::exception_ptr& thrown, bool aloud, const char* who) {
  try {
    std::rethrow_exception(thrown);
  } catch (const CaseError& error) {  // laid out already
    if (aloud) note("{}{}\n", who, error.what());
    return error.code();
  } catch (const Error& error) {
    if (aloud) note("{}error: {}\n", who, error.what());
    return error.code();
  } catch (const std::bad_alloc&) {
    if (aloud) put(stderr, who);
    return aloud ? out_of_memory() : ExitCode::input;
  } catch (const std::exception& error) {
    if (aloud) note("{}internal error: {}\n", who, error.what());
    return ExitCode::internal;
  }
}

ExitCode told(base::Communicator& ranks, const std::exception_ptr& error) {
  if (ranks.size() == 1 || ranks.failed_together(error)) return tell(error, ranks.rank() == 0, "");
  char who[64];
  std::snprintf(who, sizeof who, "rank %d of %d: ", ranks.rank(), ranks.size());
  const ExitCode code = tell(error, true, who);
  std::fflush(stdout);
  mpi::end_all(exit_code(code));
}

/// Losing what it was to print is a failure, unless there was another.
ExitCode with_delivery(ExitCode code) {
  const Delivery delivered = delivery();
  if (delivered == Delivery::lost)
    note("error: standard output cannot be written, so what should stand there is lost\n");
  return code == ExitCode::ok && delivered != Delivery::all ? ExitCode::files : code;
}

}  // namespace

int end_of(base::Communicator& ranks, const std::function<ExitCode()>& work) {
  std::int64_t code = 0;
  try {
    code = exit_code(with_delivery(work()));
  } catch (...) {
    code = exit_code(told(ranks, std::current_exception()));
  }
  if (ranks.rank() != 0) code = 0;  // rank 0 has done all the printing, and knows what came of it
  ranks.sum(std::span(&code, 1));
  return static_cast<int>(code);
}

}  // namespace gaussdrift::cli
