// The threads of OpenMP: how many can be had, and how they wait for work.
#pragma once

namespace gaussdrift::cli {

/// Sets OMP_WAIT_POLICY=passive, unless the user has said how threads wait, and OMP_THREAD_LIMIT where the system does not
/// let so many threads start as are wanted: GCC's run-time library would end the program. By default it also lets waiting
/// threads spin; on a busy machine a sum of a millisecond then takes a hundred. It reads both variables before main()
/// begins. Where it is a part of the program (GAUSSDRIFT_OPENMP_ARCHIVE) they are set before that, and this does nothing.
/// Else the program starts itself again, once; where that is not possible it goes on as it is.
void prepare_threads(char** argv);

}  // namespace gaussdrift::cli
