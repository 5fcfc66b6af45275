// How threads of OpenMP wait for work.
#pragma once

namespace gaussdrift::cli {

/// Starts the program again with OMP_WAIT_POLICY=passive, once, unless the user has said how threads wait. GCC's
/// run-time library lets waiting threads spin by default; on a busy machine a sum of a millisecond then takes a
/// hundred. It reads the variable before main() begins, so it has to stand there from the start. Where starting again
/// is not possible the program goes on as it is.
void let_waiting_threads_sleep(char** argv);

}  // namespace gaussdrift::cli
