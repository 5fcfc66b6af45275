// The threads of OpenMP: how many can be had, and how they wait for work.
#pragma once

namespace gaussdrift::cli {

/// Starts the program again, once, with OMP_WAIT_POLICY=passive, unless the user has said how threads wait, and with
/// OMP_THREAD_LIMIT where the system does not let so many threads start as are wanted: GCC's run-time library would end
/// the program. By default it also lets waiting threads spin; on a busy machine a sum of a millisecond then takes a
/// hundred. It reads both variables before main() begins, so they have to stand there from the start. Where starting
/// again is not possible the program goes on as it is.
void prepare_threads(char** argv);

}  // namespace gaussdrift::cli
